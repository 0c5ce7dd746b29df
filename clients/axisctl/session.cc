#include "clients/axisctl/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

bool is_stage(const v1::Device& device) { return !is_mill(device); }

v1::ListDevicesResponse listed_devices(const Session& session) {
  const Connection& connection = session.connection;
  // The daemon answers this question even if only the connections reserved for stops are left.
  v1::ListDevicesResponse there = connection.call(connection.devices, &v1::DeviceService::Stub::ListDevices,
                                                  v1::ListDevicesRequest(), kQuestionLimit);
  connection.repeat_by(there);
  return there;
}

// Returns the only device that fulfils `is_so`. Throws Failure if there are none or several. `kind` is its name in
// messages.
v1::Device only_one(const v1::ListDevicesResponse& there, bool (*is_so)(const v1::Device&), std::string_view kind) {
  std::vector<v1::Device> such;
  std::ranges::copy_if(there.devices(), std::back_inserter(such), is_so);
  if (such.size() == 1) return such.front();
  if (such.empty()) throw usage(fmt::format("the daemon has no {}", kind), "configure one");
  std::vector<std::string_view> names;
  for (const v1::Device& device : such) names.push_back(last_part(device.name()));
  throw usage(fmt::format("the daemon has {} {}s", names.size(), kind),
              fmt::format("choose one with --device: {}", fmt::join(names, ", ")));
}

// Returns the device named by --device. If the daemon does not list it, throws the daemon's explanation of what is
// wrong with the name.
v1::Device listed_or_refused(const Session& session, const v1::ListDevicesResponse& there) {
  const std::string& name = session.options.device;
  const auto found = std::ranges::find(there.devices(), name, &v1::Device::name);
  if (found != there.devices().end()) return *found;
  const Connection& connection = session.connection;
  v1::GetDeviceRequest request;
  request.set_device(name);
  return connection.call(connection.devices, &v1::DeviceService::Stub::GetDevice, request, kQuestionLimit).device();
}

}  // namespace

bool is_mill(const v1::Device& device) { return device.axes().empty(); }

v1::Device chosen_device(const Session& session) {
  const v1::ListDevicesResponse there = listed_devices(session);
  if (session.options.device.empty()) return only_one(there, is_stage, "stage");
  const v1::Device device = listed_or_refused(session, there);
  if (is_stage(device)) return device;
  throw Failure{kRefused, "INVALID_REQUEST", fmt::format("{} is a mill: it has no axes to move", device.name()),
                "`axisctl mill` sends jobs to it"};
}

v1::Device only_mill(const Session& session) { return only_one(listed_devices(session), is_mill, "mill"); }

v1::Device any_device(const Session& session) {
  const v1::ListDevicesResponse there = listed_devices(session);
  if (session.options.device.empty()) {
    return std::ranges::any_of(there.devices(), is_stage) ? only_one(there, is_stage, "stage")
                                                          : only_one(there, is_mill, "mill");
  }
  return listed_or_refused(session, there);
}

}  // namespace axisgate::axisctl
