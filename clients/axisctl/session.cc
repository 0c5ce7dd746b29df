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

// Reports whether the device is a mill, from its `kind` in the configuration.
bool is_mill(const v1::Device& device) { return device.kind() == "rml1"; }
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

// Returns the device with this name; null if the daemon does not list it.
const v1::Device* named_device(const v1::ListDevicesResponse& there, const std::string& name) {
  const auto found = std::ranges::find(there.devices(), name, &v1::Device::name);
  return found == there.devices().end() ? nullptr : &*found;
}

}  // namespace

v1::Device chosen_device(const Session& session) {
  const v1::ListDevicesResponse there = listed_devices(session);
  if (session.options.device.empty()) return only_one(there, is_stage, "stage");
  const v1::Device* const named = named_device(there, session.options.device);
  if (named != nullptr && is_stage(*named)) return *named;
  const Connection& connection = session.connection;
  // This call fails with a message that explains the error in the name.
  v1::GetDeviceRequest request;
  request.set_name(session.options.device);
  return connection.call(connection.devices, &v1::DeviceService::Stub::GetDevice, request, kQuestionLimit).device();
}

v1::Device only_mill(const Session& session) { return only_one(listed_devices(session), is_mill, "mill"); }

v1::Device leased_device(const Session& session) {
  const v1::ListDevicesResponse there = listed_devices(session);
  if (session.options.device.empty()) {
    return std::ranges::any_of(there.devices(), is_stage) ? only_one(there, is_stage, "stage")
                                                          : only_one(there, is_mill, "mill");
  }
  if (const v1::Device* const named = named_device(there, session.options.device)) return *named;
  v1::Device unknown;
  unknown.set_name(session.options.device);
  return unknown;
}

}  // namespace axisgate::axisctl
