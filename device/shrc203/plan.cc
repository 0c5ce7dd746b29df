#include "device/shrc203/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "device/shrc203/arc_lines.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::int64_t kSpeedMax = 1'000'000;  // pulses/s (manual 89) D:)

Result<void> check_acceleration(int axis, int milliseconds) {
  if (milliseconds >= 1 && milliseconds <= 1000) return {};
  return fail_on(axis, Reason::out_of_range,
                 fmt::format("an acceleration time of {} ms; 1 to 1000 ms are possible", milliseconds));
}

// The speeds to send: those asked for, or the device's own where they exceed what the caller may run at.
Result<std::optional<SpeedSetting>> plan_speed(const AxisMove& move, const Envelope& envelope) {
  const auto& axis = envelope.state().axis(move.axis);
  if (move.profile) {
    const auto minimum = envelope.speed(move.axis, move.profile->minimum);
    if (!minimum) return tl::unexpected(minimum.error());
    const auto maximum = envelope.speed(move.axis, move.profile->maximum);
    if (!maximum) return tl::unexpected(maximum.error());
    const int time = move.profile->acceleration_ms;
    if (auto good = check_acceleration(move.axis, time); !good) return tl::unexpected(good.error());
    if (*minimum > *maximum) {
      return fail_on(move.axis, Reason::out_of_range,
                     fmt::format("{}: the lowest speed S of {} pulses/s must not exceed the highest, F of {}",
                                 envelope.label(move.axis), *minimum, *maximum));
    }
    return std::optional(SpeedSetting{*minimum, *maximum, time});
  }
  const auto cap = envelope.speed_cap(move.axis);
  if (!cap) return tl::unexpected(cap.error());
  if (!*cap || (axis.maximum_speed && *axis.maximum_speed <= **cap)) return std::optional<SpeedSetting>();
  return std::optional(
      SpeedSetting{std::min(axis.minimum_speed.value_or(1), **cap), **cap, axis.acceleration_ms.value_or(100)});
}

Duration seconds(double value) { return std::chrono::nanoseconds(static_cast<std::int64_t>(value * 1e9)); }

// From rest to rest: from S towards F, which R milliseconds would lead to, and back, with or without a stretch at F.
double seconds_of_one_axis(double way, const SpeedSetting& speed) {
  const auto minimum = static_cast<double>(speed.minimum), maximum = static_cast<double>(speed.maximum);
  const double ramp = static_cast<double>(speed.acceleration_ms) / 1000;
  const double both_ramps = (minimum + maximum) * ramp;
  if (way >= both_ramps) return 2 * ramp + (way - both_ramps) / maximum;
  const double acceleration = (maximum - minimum) / ramp;
  if (acceleration == 0) return way / maximum;
  return 2 * (std::sqrt(minimum * minimum + acceleration * way) - minimum) / acceleration;
}

// How long the segment's pulses take: a straight line runs at its lower axis's S throughout (manual 83)), one axis
// accelerates from S to F in R (manual 89)).
void plan_time(SegmentPlan& segment, const std::vector<double>& ways, const SpeedSetting& speed) {
  double length = 0;
  for (const double way : ways) length += way * way;
  length = std::sqrt(length);
  if (ways.size() > 1) {
    segment.shortest = segment.longest = seconds(length / static_cast<double>(speed.minimum));
  } else {
    segment.shortest = seconds(seconds_of_one_axis(length, speed));
    segment.longest =
        seconds(length / static_cast<double>(speed.maximum)) + 2 * std::chrono::milliseconds(speed.acceleration_ms);
  }
}

SpeedSetting known_speed(const State& state, int axis) {
  const auto& one = state.axis(axis);
  return {one.minimum_speed.value_or(1), one.maximum_speed.value_or(kSpeedMax), one.acceleration_ms.value_or(1000)};
}

tl::unexpected<Problem> in_segment(std::size_t index, Problem problem) {
  problem.message = fmt::format("segment {}: {}", index + 1, problem.message);
  return tl::unexpected(std::move(problem));
}

// The speed of a segment: a path speed is the lower axis's S; one axis's speed is its F.
Result<std::optional<SpeedSetting>> segment_speed(const Segment& segment, const MovePlan& move,
                                                  const Envelope& envelope, const SpeedSetting& before) {
  const int axis = move.axes.front().axis;
  if (!segment.speed && !segment.acceleration_ms) return move.axes.front().speed;
  // One axis runs at F, which may be more than the caller may run at.
  SpeedSetting speed = move.axes.size() == 1 ? move.axes.front().speed.value_or(before) : before;
  speed.acceleration_ms = segment.acceleration_ms.value_or(before.acceleration_ms);
  if (auto good = check_acceleration(axis, speed.acceleration_ms); !good) return tl::unexpected(good.error());
  if (segment.speed) {
    const auto asked = envelope.speed(axis, *segment.speed);
    if (!asked) return tl::unexpected(asked.error());
    if (move.axes.size() > 1) {
      speed.minimum = *asked;
      speed.maximum = std::max(before.maximum, *asked);
    } else {
      speed.maximum = *asked;
      speed.minimum = std::min(before.minimum, *asked);
    }
  }
  return std::optional(speed);
}

// Each axis of a straight line takes its part of the line's speed.
Result<void> check_line_speed(const MovePlan& move, const std::vector<double>& ways, const SpeedSetting& speed,
                              const Envelope& envelope) {
  double length = 0;
  for (const double way : ways) length += way * way;
  for (std::size_t i = 0; i < ways.size() && ways.size() > 1 && length > 0; ++i) {
    const double part = static_cast<double>(speed.minimum) * std::abs(ways[i]) / std::sqrt(length);
    const auto good = envelope.check_speed(move.axes[i].axis, static_cast<std::int64_t>(part));
    if (!good) return good;
  }
  return {};
}

Result<void> check_segment(const Segment& segment, const MovePlan& move, AxisSet axes, const State& state) {
  if (move.set() != axes) {
    return fail(Reason::invalid_request, "every segment of a path names the same axes",
                "repeat the axis with a distance of 0");
  }
  if (axes.count() > 1 && !segment.relative) {
    return fail(Reason::invalid_request, "a straight line is relative: the controller knows no absolute one (KP:)",
                "give the way instead of the target");
  }
  return check_scales(axes, state);
}

}  // namespace

AxisSet MovePlan::set() const {
  AxisSet axes_named;
  for (const auto& one : axes) axes_named.add(one.axis);
  return axes_named;
}

std::map<int, SpeedSetting> speeds_of(const MovePlan& plan) {
  std::map<int, SpeedSetting> speeds;
  for (const auto& axis : plan.axes) {
    if (axis.speed) speeds[axis.axis] = *axis.speed;
  }
  return speeds;
}

Register PathPlan::reg() const {
  if (axes.count() > 1) return Register::kp;
  return segments.front().move.relative ? Register::mp : Register::ap;
}

Positions positions_of(const State& state) {
  Positions positions;
  for (std::size_t i = 0; i < kAxisCount; ++i) positions[i] = state.axes[i].position_pulses;
  return positions;
}

Result<MovePlan> plan_move(const std::vector<AxisMove>& moves, bool relative, const Positions& from,
                           const Envelope& envelope) {
  if (moves.empty()) return fail(Reason::invalid_request, "no axis was named", "name an axis and a distance");
  MovePlan plan{relative, {}};
  for (const AxisMove& move : moves) {
    if (auto good = envelope.check_axis(move.axis); !good) return tl::unexpected(good.error());
    if (auto good = envelope.check_homed(move.axis); !good) return tl::unexpected(good.error());
    if (plan.set().has(move.axis)) {
      return fail_on(move.axis, Reason::invalid_request, fmt::format("{} is named twice", envelope.label(move.axis)));
    }
    const auto amount = envelope.pulses(move.axis, move.distance);
    if (!amount) return tl::unexpected(amount.error());
    auto speed = plan_speed(move, envelope);
    if (!speed) return tl::unexpected(speed.error());
    AxisPlan one{move.axis, *amount, {}, *speed};
    const auto& start = from[static_cast<std::size_t>(move.axis - 1)];
    if (!relative) one.target = *amount;
    if (relative && start) one.target = *start + *amount;
    if (one.target) {
      if (auto good = envelope.check_target(move.axis, *one.target); !good) return tl::unexpected(good.error());
    }
    plan.axes.push_back(one);
  }
  std::ranges::sort(plan.axes, {}, &AxisPlan::axis);
  return plan;
}

Result<PathPlan> plan_path(const PathRequest& request, const Positions& from, const Envelope& envelope) {
  const State& state = envelope.state();
  if (request.segments.empty() || request.segments.size() > PathRequest::kSegmentsMax) {
    return fail(Reason::invalid_request,
                fmt::format("a path has 1 to {} segments, not {}", PathRequest::kSegmentsMax, request.segments.size()));
  }
  PathPlan path;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) path.begin[axis] = from[axis].value_or(0);
  Positions at = from;
  SpeedSetting speed{};
  for (std::size_t index = 0; index < request.segments.size(); ++index) {
    const Segment& segment = request.segments[index];
    auto move = plan_move(segment.moves, segment.relative, at, envelope);
    if (!move) return in_segment(index, move.error());
    if (index == 0) {
      path.axes = move->set();
      speed = known_speed(state, path.axes.lowest());
    }
    if (auto good = check_segment(segment, *move, path.axes, state); !good) return in_segment(index, good.error());
    auto set = segment_speed(segment, *move, envelope, speed);
    if (!set) return in_segment(index, set.error());
    for (auto& one : move->axes) one.speed.reset();
    move->axes.front().speed = *set;
    if (*set) speed = **set;

    SegmentPlan planned{*std::move(move), {}, {}, {}};
    std::vector<double> ways;
    for (const auto& one : planned.move.axes) {
      auto& position = at[static_cast<std::size_t>(one.axis - 1)];
      if (!position) {
        return fail_on(one.axis, Reason::position_unknown,
                       fmt::format("where {} stands is not known", envelope.label(one.axis)),
                       "wait until the device is up");
      }
      ways.push_back(static_cast<double>(*one.target - *position));
      position = *one.target;
    }
    if (auto good = check_line_speed(planned.move, ways, speed, envelope); !good) {
      return in_segment(index, good.error());
    }
    if (std::ranges::all_of(ways, [](double way) { return way == 0; })) {
      return in_segment(index, {Reason::invalid_request, "it moves nothing", "leave it out", {}, {}, {}});
    }
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) planned.end[axis] = at[axis].value_or(0);
    plan_time(planned, ways, speed);
    path.segments.push_back(std::move(planned));
  }
  return path;
}

}  // namespace axisgate::shrc203
