#include "server/api/names.h"

#include <fmt/format.h>

#include <charconv>

#include "device/core/escape.h"
#include "server/devices/saved_positions.h"

namespace axisgate::api {
namespace {

constexpr std::string_view kDevices = "devices/";
constexpr std::string_view kMotions = "/motions/";
constexpr std::string_view kPositions = "/positions/";

}  // namespace

std::string device_name(std::string_view device_of_config) { return fmt::format("{}{}", kDevices, device_of_config); }

std::string motion_name(std::string_view device_of_config, stage::MotionId motion) {
  return fmt::format("{}{}{}{}", kDevices, device_of_config, kMotions, motion);
}

std::string position_name(std::string_view device_of_config, std::string_view position) {
  return fmt::format("{}{}{}{}", kDevices, device_of_config, kPositions, position);
}

std::string stage_names(const server::Gateway& gateway) {
  std::string names;
  for (const auto& device : gateway.stages()) names += (names.empty() ? "" : ", ") + device_name(device->name());
  return names;
}

Result<server::Stage*> find_stage(const server::Gateway& gateway, std::string_view name) {
  if (!name.starts_with(kDevices)) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a device", escaped(name)),
                "write \"devices/\" and its name in the configuration, e.g. \"devices/stage\"");
  }
  if (server::Stage* device = gateway.find_stage(name.substr(kDevices.size()))) return device;
  return fail(Reason::unknown_device, fmt::format("no device is named \"{}\"", escaped(name)),
              "there is " + stage_names(gateway));
}

Result<MotionName> find_motion_name(const server::Gateway& gateway, std::string_view name) {
  const std::size_t split = name.find(kMotions);
  MotionName found;
  bool well_formed = split != std::string_view::npos;
  if (well_formed) {
    const std::string_view id = name.substr(split + kMotions.size());
    const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), found.id);
    well_formed = error == std::errc() && end == id.data() + id.size();
  }
  if (!well_formed) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a motion", escaped(name)),
                "take it from Motion.name, e.g. \"devices/stage/motions/1\"");
  }
  const Result<server::Stage*> device = find_stage(gateway, name.substr(0, split));
  if (!device) return tl::unexpected(device.error());
  found.device = *device;
  return found;
}

Result<PositionName> find_position_name(const server::Gateway& gateway, std::string_view name) {
  const std::size_t split = name.find(kPositions);
  const std::string_view own = split == std::string_view::npos ? "" : name.substr(split + kPositions.size());
  if (!server::is_position_name(own)) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a position", escaped(name)),
                fmt::format("write \"devices/stage/positions/sample\"; a name has 1 to {} letters, digits, '-' and '_'",
                            server::SavedPositions::kNameMax));
  }
  const Result<server::Stage*> device = find_stage(gateway, name.substr(0, split));
  if (!device) return tl::unexpected(device.error());
  return PositionName{*device, std::string(own)};
}

}  // namespace axisgate::api
