// Names of devices, motions, stops, jobs and positions, as callers use them.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/jobs/job.h"
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

// Returns the names of all devices for people: "devices/a, devices/b".
std::string device_names(const server::Gateway& gateway);

// Fails with invalid_request if the name is not "devices/{d}", and with unknown_device if no device has it.
Result<server::Device*> find_device(const server::Gateway& gateway, std::string_view name);
// Fails with invalid_request if the name is not "devices/{d}", or if the device is of another family; and with
// unknown_device if no device has the name.
Result<server::Stage*> find_stage(const server::Gateway& gateway, std::string_view name);

// Does the same for mills.
Result<server::Mill*> find_mill(const server::Gateway& gateway, std::string_view name);

std::string job_name(std::string_view device_of_config, jobs::JobNumber job);  // "devices/{d}/jobs/{number}"
struct JobName {
  server::Mill* device = nullptr;  // never null
  jobs::JobNumber number = 0;
};
// Fails with invalid_request if the name is not "devices/{d}/jobs/{number}", and with unknown_device. Does not check
// that the job exists.
Result<JobName> find_job_name(const server::Gateway& gateway, std::string_view name);

struct MotionName {
  server::Stage* device = nullptr;  // never null
  stage::MotionId id = 0;
};
// Fails with invalid_request if the name is not "devices/{d}/motions/{id}", and with unknown_device. Does not check
// that the motion exists.
Result<MotionName> find_motion_name(const server::Gateway& gateway, std::string_view name);

struct StopName {
  server::Stage* device = nullptr;  // never null
  stage::StopId id = 0;
};
// Fails with invalid_request if the name is not "devices/{d}/stops/{id}", and with unknown_device. Does not check that
// the stop exists.
Result<StopName> find_stop_name(const server::Gateway& gateway, std::string_view name);

struct PositionName {
  server::Stage* device = nullptr;  // never null
  std::string name;
};
// Fails with invalid_request if the name is not "devices/{d}/positions/{name}", and with unknown_device. Does not check
// that the position exists.
Result<PositionName> find_position_name(const server::Gateway& gateway, std::string_view name);

// Returns the device of a name that was found.
template <class Name>
auto device_of(const Result<Name>& name) -> Result<decltype(Name::device)> {
  if (!name) return tl::unexpected(name.error());
  return name->device;
}

}  // namespace axisgate::api
