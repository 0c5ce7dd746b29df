#include "clients/axisctl/session.h"

#include <fmt/format.h>

#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

v1::Device only_device(const Connection& connection) {
  const v1::ListDevicesResponse answer = connection.call(connection.devices, &v1::DeviceService::Stub::ListDevices,
                                                         v1::ListDevicesRequest(), kQuestionLimit);
  if (answer.devices_size() == 1) return answer.devices(0);
  std::vector<std::string_view> names;
  for (const v1::Device& device : answer.devices()) names.push_back(last_part(device.name()));
  throw usage(fmt::format("the daemon has {} devices", names.size()),
              names.empty() ? "configure one" : fmt::format("choose one with --device: {}", fmt::join(names, ", ")));
}

}  // namespace

v1::Device chosen_device(const Session& session) {
  if (session.options.device.empty()) return only_device(session.connection);
  v1::GetDeviceRequest request;
  request.set_name(session.options.device);
  return session.connection
      .call(session.connection.devices, &v1::DeviceService::Stub::GetDevice, request, kQuestionLimit)
      .device();
}

}  // namespace axisgate::axisctl
