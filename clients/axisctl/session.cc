#include "clients/axisctl/session.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

v1::Device only_device(const v1::ListDevicesResponse& there) {
  if (there.devices_size() == 1) return there.devices(0);
  std::vector<std::string_view> names;
  for (const v1::Device& device : there.devices()) names.push_back(last_part(device.name()));
  throw usage(fmt::format("the daemon has {} devices", names.size()),
              names.empty() ? "configure one" : fmt::format("choose one with --device: {}", fmt::join(names, ", ")));
}

// Nothing: the daemon lists none of the name that was typed.
std::optional<v1::Device> listed_device(const Session& session) {
  const Connection& connection = session.connection;
  // The one question that the daemon answers even when it has no connection left but for a stop.
  const v1::ListDevicesResponse there = connection.call(connection.devices, &v1::DeviceService::Stub::ListDevices,
                                                        v1::ListDevicesRequest(), kQuestionLimit);
  connection.repeat_by(there);
  if (session.options.device.empty()) return only_device(there);
  for (const v1::Device& device : there.devices()) {
    if (device.name() == session.options.device) return device;
  }
  return std::nullopt;
}

}  // namespace

v1::Device chosen_device(const Session& session) {
  if (const auto listed = listed_device(session)) return *listed;
  const Connection& connection = session.connection;
  // The daemon says what is wrong with the name.
  v1::GetDeviceRequest request;
  request.set_name(session.options.device);
  return connection.call(connection.devices, &v1::DeviceService::Stub::GetDevice, request, kQuestionLimit).device();
}

// The daemon lists stages only.
v1::Device leased_device(const Session& session) {
  if (const auto listed = listed_device(session)) return *listed;
  v1::Device mill;
  mill.set_name(session.options.device);
  return mill;
}

}  // namespace axisgate::axisctl
