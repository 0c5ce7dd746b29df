#include "server/rpc/call.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <optional>
#include <utility>

#include "device/core/escape.h"
#include "server/events/wall_time.h"
#include "server/rpc/gatekeeper.h"

namespace axisgate::rpc {
namespace {

using server::WallTime;

constexpr std::string_view kDevices = "devices/";
constexpr std::string_view kMotions = "/motions/";
constexpr std::size_t kRequestIdMax = 128;
constexpr Duration kMotionPatience = std::chrono::seconds(5);
constexpr Duration kPatience = std::chrono::seconds(20);

std::optional<TimePoint> call_deadline(const grpc::CallbackServerContext& call) {
  if (call.deadline() == WallTime::max()) return std::nullopt;
  return server::to_monotonic(call.deadline());
}

std::optional<TimePoint> not_after(const api::CallContext& context) {
  if (!context.has_not_after()) return std::nullopt;
  // Bounded, so that a time in the far future does not overflow nanoseconds.
  constexpr std::int64_t kSecondsMax = 4'000'000'000;
  const std::int64_t seconds = std::clamp<std::int64_t>(context.not_after().seconds(), 0, kSecondsMax);
  const auto since_epoch = std::chrono::seconds(seconds) + std::chrono::nanoseconds(context.not_after().nanos());
  return server::to_monotonic(WallTime(std::chrono::duration_cast<WallTime::duration>(since_epoch)));
}

Result<stage::RequestContext> context_until(const grpc::CallbackServerContext& call, const api::CallContext& context,
                                            TimePoint otherwise) {
  const std::string& id = context.request_id();
  const bool printable = std::all_of(id.begin(), id.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (id.size() > kRequestIdMax || !printable) {
    return fail(Reason::invalid_request,
                fmt::format("context.request_id is not at most {} printable ASCII characters", kRequestIdMax));
  }
  TimePoint until = not_after(context).value_or(otherwise);
  if (const auto deadline = call_deadline(call)) until = std::min(until, *deadline);
  return stage::RequestContext{.who = caller(call),
                               .request_id = id,
                               .not_after = until,
                               .lease = context.lease_token(),
                               .device_epoch = context.device_epoch(),
                               .frame_epoch = context.frame_epoch()};
}

}  // namespace

std::string device_name(const server::Device& device) { return std::string(kDevices) + device.name(); }

std::string motion_name(std::string_view device_of_config, stage::MotionId motion) {
  return fmt::format("{}{}{}{}", kDevices, device_of_config, kMotions, motion);
}

Result<server::Device*> find_device(const server::Gateway& gateway, std::string_view name) {
  if (!name.starts_with(kDevices)) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is not the name of a device", escaped(name)),
                "write \"devices/\" and its name in the configuration, e.g. \"devices/stage\"");
  }
  if (server::Device* device = gateway.find(name.substr(kDevices.size()))) return device;
  std::string known;
  for (const auto& device : gateway.devices()) known += (known.empty() ? "" : ", ") + device_name(*device);
  return fail(Reason::unknown_device, fmt::format("no device is named \"{}\"", escaped(name)), "there is " + known);
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
  const Result<server::Device*> device = find_device(gateway, name.substr(0, split));
  if (!device) return tl::unexpected(device.error());
  found.device = *device;
  return found;
}

Result<stage::Motion> find_motion(const stage::StageController& controller, stage::MotionId id) {
  if (std::optional<stage::Motion> motion = controller.find_motion(id)) return *std::move(motion);
  return fail(Reason::not_found, fmt::format("there is no motion {} on {}", id, controller.profile().name),
              fmt::format("the newest {} since the daemon started are kept; ListMotions shows them",
                          stage::StageController::kMotionsKept));
}

Result<stage::RequestContext> motion_context(const grpc::CallbackServerContext& call, const api::CallContext& context,
                                             const server::Access& access) {
  auto asked = context_until(call, context, monotonic_now() + kMotionPatience);
  const Result<std::string> role = role_of(call, access);
  if (!role) return tl::unexpected(role.error());
  if (asked) asked->role = *role;
  return asked;
}

Result<stage::RequestContext> mutation_context(const grpc::CallbackServerContext& call,
                                               const api::CallContext& context) {
  return context_until(call, context, call_deadline(call).value_or(monotonic_now() + kPatience));
}

stage::RequestContext stop_context(const grpc::CallbackServerContext& call, const api::CallContext& context) {
  stage::RequestContext asked = question_context(call);
  asked.request_id = escaped(context.request_id(), kRequestIdMax);
  asked.lease = context.lease_token();
  return asked;
}

stage::RequestContext question_context(const grpc::CallbackServerContext& call) {
  return {.who = caller(call), .not_after = call_deadline(call).value_or(monotonic_now() + kPatience)};
}

}  // namespace axisgate::rpc
