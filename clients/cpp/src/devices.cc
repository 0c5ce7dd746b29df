#include "clients/cpp/src/devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "clients/cpp/src/outcomes.h"

namespace axisgate::client {
namespace {

bool moves_axes(const v1::Device& device) {
  return std::ranges::find(device.capabilities(), v1::CAPABILITY_MOVE) != device.capabilities().end();
}

v1::Device stage_in(const v1::ListDevicesResponse& listed, const std::string& name) {
  std::vector<std::string> names;
  std::vector<v1::Device> able;
  for (const v1::Device& device : listed.devices()) {
    names.push_back(last_part(device.name()));
    if (moves_axes(device) && (name.empty() || last_part(name) == names.back())) able.push_back(device);
  }
  if (able.size() == 1) return able.front();
  const std::string all = fmt::format("{}", fmt::join(names, ", "));
  if (able.size() > 1) {
    throw InvalidArgument("the daemon has several stages; choose one of these by ConnectOptions::device: " + all);
  }
  throw InvalidArgument(fmt::format("the daemon has no stage{}; its devices: {}", name.empty() ? "" : " " + name, all));
}

}  // namespace

std::shared_ptr<DeviceSession> open_stage(const ConnectOptions& options) {
  auto connection = std::make_shared<Connection>(options);
  const v1::Device device = stage_in(connection->open(), options.device);
  return std::make_shared<DeviceSession>(std::move(connection), device);
}

std::vector<std::string> stage_names(const ConnectOptions& options) {
  std::vector<std::string> names;
  const v1::ListDevicesResponse listed = Connection(options).open();
  for (const v1::Device& device : listed.devices()) {
    if (moves_axes(device)) names.push_back(last_part(device.name()));
  }
  return names;
}

}  // namespace axisgate::client
