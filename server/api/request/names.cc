#include "server/api/request/names.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "device/core/escape.h"
#include "server/devices/saved_positions.h"

namespace axisgate::api {
namespace {

constexpr std::string_view kDevices = "devices/";
constexpr std::string_view kMotions = "/motions/";
constexpr std::string_view kStops = "/stops/";
constexpr std::string_view kJobs = "/jobs/";
constexpr std::string_view kPositions = "/positions/";

// Splits a name into "devices/{d}" and the number after `between`. Returns nullopt if the name has another form.
std::optional<std::pair<std::string_view, std::uint64_t>> numbered(std::string_view name, std::string_view between) {
  const std::size_t split = name.find(between);
  if (split == std::string_view::npos) return std::nullopt;
  const std::string_view digits = name.substr(split + between.size());
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return std::pair(name.substr(0, split), number);
}

}  // namespace

std::string device_name(std::string_view device_of_config) { return fmt::format("{}{}", kDevices, device_of_config); }

std::string stop_name(std::string_view device_of_config, stage::StopId stop) {
  return fmt::format("{}{}{}{}", kDevices, device_of_config, kStops, stop);
}

std::string motion_name(std::string_view device_of_config, stage::MotionId motion) {
  return fmt::format("{}{}{}{}", kDevices, device_of_config, kMotions, motion);
}

std::string position_name(std::string_view device_of_config, std::string_view position) {
  return fmt::format("{}{}{}{}", kDevices, device_of_config, kPositions, position);
}

std::string job_name(std::string_view device_of_config, jobs::JobNumber job) {
  return fmt::format("{}{}{}{}", kDevices, device_of_config, kJobs, job);
}

std::string device_names(const server::Gateway& gateway) {
  std::string names;
  for (const auto& device : gateway.devices()) names += (names.empty() ? "" : ", ") + device_name(device->name());
  return names;
}

Result<server::Device*> find_device(const server::Gateway& gateway, std::string_view name) {
  if (!name.starts_with(kDevices)) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a device", escaped(name)),
                "write \"devices/\" and its name in the configuration, e.g. \"devices/stage\"");
  }
  const std::string_view own = name.substr(kDevices.size());
  for (const auto& device : gateway.devices()) {
    if (device->name() == own) return device.get();
  }
  return fail(Reason::unknown_device, fmt::format("no device is named \"{}\"", escaped(name)),
              "there is " + device_names(gateway));
}

Result<server::Stage*> find_stage(const server::Gateway& gateway, std::string_view name) {
  const Result<server::Device*> device = find_device(gateway, name);
  if (!device) return tl::unexpected(device.error());
  if (auto* stage = dynamic_cast<server::Stage*>(*device)) return stage;
  return fail(Reason::invalid_request, fmt::format("{} is a mill: it has no axes to move", escaped(name)),
              "send jobs to it: `SendJob`");
}

Result<server::Mill*> find_mill(const server::Gateway& gateway, std::string_view name) {
  const Result<server::Device*> device = find_device(gateway, name);
  if (!device) return tl::unexpected(device.error());
  if (auto* mill = dynamic_cast<server::Mill*>(*device)) return mill;
  return fail(Reason::invalid_request, fmt::format("{} is no mill", escaped(name)), "jobs are for mills");
}

Result<MotionName> find_motion_name(const server::Gateway& gateway, std::string_view name) {
  const auto parts = numbered(name, kMotions);
  if (!parts) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a motion", escaped(name)),
                "take it from Motion.name, e.g. \"devices/stage/motions/1\"");
  }
  return find_stage(gateway, parts->first).map([&](server::Stage* stage) { return MotionName{stage, parts->second}; });
}

Result<StopName> find_stop_name(const server::Gateway& gateway, std::string_view name) {
  const auto parts = numbered(name, kStops);
  if (!parts) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a stop", escaped(name)),
                "take it from OpenStop.name, e.g. \"devices/stage/stops/1\"");
  }
  return find_stage(gateway, parts->first).map([&](server::Stage* stage) { return StopName{stage, parts->second}; });
}

Result<JobName> find_job_name(const server::Gateway& gateway, std::string_view name) {
  const auto parts = numbered(name, kJobs);
  if (!parts) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a job", escaped(name)),
                "take it from Job.name, e.g. \"devices/mill/jobs/1\"");
  }
  return find_mill(gateway, parts->first).map([&](server::Mill* mill) { return JobName{mill, parts->second}; });
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
