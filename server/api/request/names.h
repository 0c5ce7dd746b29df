// Devices, motions and positions by the names that callers use.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/rml1/mill/job.h"
#include "device/stage/motion.h"
#include "device/stage/stop.h"
#include "server/devices/mill.h"
#include "server/gateway.h"

namespace axisgate::api {

std::string device_name(std::string_view device_of_config);                          // "devices/{d}"
std::string motion_name(std::string_view device_of_config, stage::MotionId motion);  // "devices/{d}/motions/{id}"
std::string stop_name(std::string_view device_of_config, stage::StopId stop);        // "devices/{d}/stops/{id}"
std::string position_name(std::string_view device_of_config,
                          std::string_view position);  // "devices/{d}/positions/{name}"

// "devices/a, devices/b": all devices, for people.
std::string device_names(const server::Gateway& gateway);

// invalid_request where the name is not "devices/{d}"; unknown_device.
Result<server::Device*> find_device(const server::Gateway& gateway, std::string_view name);
// invalid_request where the name is not "devices/{d}", or is that of another family of devices; unknown_device where no
// device has that name.
Result<server::Stage*> find_stage(const server::Gateway& gateway, std::string_view name);

// The same for mills.
Result<server::Mill*> find_mill(const server::Gateway& gateway, std::string_view name);

std::string job_name(std::string_view device_of_config, rml1::JobNumber job);  // "devices/{d}/jobs/{number}"
struct JobName {
  server::Mill* device = nullptr;  // never null
  rml1::JobNumber number = 0;
};
// invalid_request where the name is not "devices/{d}/jobs/{number}", unknown_device. Whether there is such a job is not
// looked up.
Result<JobName> find_job_name(const server::Gateway& gateway, std::string_view name);

struct MotionName {
  server::Stage* device = nullptr;  // never null
  stage::MotionId id = 0;
};
// invalid_request where the name is not "devices/{d}/motions/{id}", unknown_device. Whether there is such a motion is
// not looked up.
Result<MotionName> find_motion_name(const server::Gateway& gateway, std::string_view name);

struct StopName {
  server::Stage* device = nullptr;  // never null
  stage::StopId id = 0;
};
// Fails with invalid_request if the name is not "devices/{d}/stops/{id}", and with unknown_device. Does not look up
// whether there is such a stop.
Result<StopName> find_stop_name(const server::Gateway& gateway, std::string_view name);

struct PositionName {
  server::Stage* device = nullptr;  // never null
  std::string name;
};
// invalid_request where it is not "devices/{d}/positions/{name}", unknown_device. Likewise.
Result<PositionName> find_position_name(const server::Gateway& gateway, std::string_view name);

// The device of a name that was found.
template <class Name>
auto device_of(const Result<Name>& name) -> Result<decltype(Name::device)> {
  if (!name) return tl::unexpected(name.error());
  return name->device;
}

}  // namespace axisgate::api
