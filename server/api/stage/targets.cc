#include "server/api/stage/targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::api {
namespace {

tl::unexpected<Problem> speeds_need(std::string_view what) {
  return fail(Reason::invalid_request, fmt::format("the axis's present {} is not known yet", what),
              "give minimum, maximum and acceleration_time, or ask again once the device's link is up");
}

// Returns the present S, lowered to the new F if it is above it, because S <= F (manual 89) D:).
Result<Quantity> minimum_under(const Quantity& maximum, const stage::AxisState& axis) {
  if (!axis.minimum_speed) return speeds_need("minimum speed S");
  if (maximum.unit != Unit::pulses && !axis.scale) return speeds_need("scale");
  const Result<std::int64_t> highest = to_pulses_per_second(maximum, axis.scale.value_or(Scale{}));
  if (!highest) return tl::unexpected(highest.error());
  return pulses(std::min(*axis.minimum_speed, *highest));
}

Result<stage::AxisMove> completed_target(const AxisTarget& target, const stage::State& state) {
  stage::AxisMove move{target.axis, target.distance, std::nullopt, target.approach};
  if (target.speeds) {
    const Result<stage::SpeedProfile> speeds = completed(*target.speeds, state.axis(target.axis));
    if (!speeds) return tl::unexpected(on_axis(target.axis, speeds.error()));
    move.profile = *speeds;
  }
  if (target.approach && target.approach->value.digits == 0) {
    return tl::unexpected(on_axis(target.axis, Problem{.reason = Reason::invalid_request,
                                                       .message = "an approach of 0 has no direction",
                                                       .hint = "leave it out to go straight there"}));
  }
  return move;
}

}  // namespace

Result<void> check_axes(stage::AxisSet named, const server::Device& device) {
  if (device.whole().contains(named)) return {};
  const auto there = stage::AxisSet::in(device.whole());
  return fail(Reason::unknown_axis, fmt::format("{} has no {}", device.name(), to_string(named - there)),
              fmt::format("it has {}", to_string(there)));
}

Problem on_axis(int axis, Problem problem) {
  problem.message = fmt::format("axis {}: {}", axis, problem.message);
  problem.axis = axis;
  return problem;
}

Result<stage::AxisSet> controllable_axes(stage::AxisSet named, const stage::State& state) {
  const stage::AxisSet controllable = state.controllable();
  if (controllable.empty()) {
    return fail(Reason::link_down, state.link_problem.empty() ? "it is not known yet which axes the device has"
                                                              : "the device cannot be asked: " + state.link_problem);
  }
  if (named.empty()) return controllable;
  if (controllable.contains(named)) return named;
  const stage::AxisSet missing = named - controllable;
  return fail(Reason::unknown_axis, fmt::format("{} cannot be moved here", to_string(missing)),
              fmt::format("the controller is set to {} (?:AXIS)", to_string(controllable)));
}

Result<stage::SpeedProfile> completed(const Speeds& speeds, const stage::AxisState& axis) {
  stage::SpeedProfile all;
  if (!speeds.maximum && !axis.maximum_speed) return speeds_need("maximum speed F");
  all.maximum = speeds.maximum ? *speeds.maximum : pulses(*axis.maximum_speed);
  const Result<Quantity> minimum = speeds.minimum ? *speeds.minimum : minimum_under(all.maximum, axis);
  if (!minimum) return tl::unexpected(minimum.error());
  all.minimum = *minimum;
  if (!speeds.acceleration_ms && !axis.acceleration_ms) return speeds_need("acceleration time R");
  all.acceleration_ms = speeds.acceleration_ms ? *speeds.acceleration_ms : *axis.acceleration_ms;
  return all;
}

Result<std::int64_t> to_drive_pulses(const Quantity& distance, int axis, const stage::State& state) {
  const std::optional<Scale>& scale = state.axis(axis).scale;
  if (distance.unit != Unit::pulses && !scale) {
    return fail(Reason::link_down, fmt::format("the resolution of axis {} is not known yet", axis),
                "try again when the device is up");
  }
  const Result<std::int64_t> pulses = to_pulses(distance, scale.value_or(Scale{}));
  if (!pulses) return tl::unexpected(on_axis(axis, pulses.error()));
  return pulses;
}

Result<stage::ScanRequest> completed(const Scan& scan, const stage::State& state, use::RequestContext context) {
  const Result<std::int64_t> interval = to_drive_pulses(scan.interval, scan.request.axis, state);
  if (!interval) return tl::unexpected(interval.error());
  stage::ScanRequest request = scan.request;
  request.interval = *interval;
  request.context = std::move(context);
  return request;
}

Result<stage::MoveRequest> completed(const Move& move, const stage::State& state, use::RequestContext context) {
  stage::MoveRequest request;
  request.relative = move.relative;
  request.context = std::move(context);
  for (const AxisTarget& target : move.targets) {
    Result<stage::AxisMove> one = completed_target(target, state);
    if (!one) return tl::unexpected(one.error());
    request.moves.push_back(*std::move(one));
  }
  return request;
}

}  // namespace axisgate::api
