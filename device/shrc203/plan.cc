#include "device/shrc203/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace axisgate::shrc203 {
namespace {

constexpr std::int64_t kSpeedMax = 1'000'000;  // pulses/s (manual 89) D:)
constexpr std::int64_t kPulsesMax = 999'999'999;

const AxisProfile& profile_of(const Profile& profile, int axis) {
  return profile.axes[static_cast<std::size_t>(axis - 1)];
}

std::string label(const Profile& profile, int axis) {
  const auto& name = profile_of(profile, axis).name;
  return name.empty() ? fmt::format("axis {}", axis) : fmt::format("axis {} ({})", axis, name);
}

tl::unexpected<Problem> on_axis(int axis, Problem problem) {
  problem.axis = axis;
  return tl::unexpected(std::move(problem));
}

Result<void> check_axis(int axis, const Profile& profile, const State& state) {
  if (axis < 1 || axis > kAxisCount) {
    return fail(Reason::unknown_axis, fmt::format("there is no axis {}: an SHRC-203 has axes 1 to 3", axis));
  }
  if (state.controllable().empty()) {
    return fail(Reason::link_down,
                "the device has not been up yet" + (state.link_problem.empty() ? "" : ": " + state.link_problem),
                "try again when it is up");
  }
  if (!state.axis(axis).controllable) {
    return on_axis(
        axis, {Reason::unknown_axis,
               fmt::format("{} is not controllable on this unit (memory switch GENERAL-AXIS)", label(profile, axis)),
               "use one of the controllable axes",
               {},
               {},
               {}});
  }
  if (!state.axis(axis).scale) {
    return on_axis(axis, {Reason::position_unknown,
                          fmt::format("the way of one pulse of {} is not known yet", label(profile, axis)),
                          "wait until the device is up",
                          {},
                          {},
                          {}});
  }
  return {};
}

std::string as_text(std::int64_t pulses, int axis, const Profile& profile, const State& state) {
  const Unit unit = profile_of(profile, axis).unit;
  const auto value = from_pulses(pulses, unit, *state.axis(axis).scale);
  if (!value) return fmt::format("{} pulses", pulses);
  return to_string(*value) + std::string(symbol(unit));
}

Result<void> check_travel(int axis, std::int64_t target, const Profile& profile, const State& state) {
  const auto& limits = profile_of(profile, axis);
  const auto outside = [&](std::int64_t bound, std::string_view side) {
    return on_axis(axis,
                   {Reason::outside_travel,
                    fmt::format("{} would go to {}, beyond its {} of {}", label(profile, axis),
                                as_text(target, axis, profile, state), side, as_text(bound, axis, profile, state)),
                    "stay within the travel that the configuration allows",
                    {},
                    {},
                    {}});
  };
  if (limits.travel_minimum) {
    const auto bound = to_pulses(*limits.travel_minimum, *state.axis(axis).scale);
    if (!bound) return on_axis(axis, bound.error());
    if (target < *bound) return outside(*bound, "travel minimum");
  }
  if (limits.travel_maximum) {
    const auto bound = to_pulses(*limits.travel_maximum, *state.axis(axis).scale);
    if (!bound) return on_axis(axis, bound.error());
    if (target > *bound) return outside(*bound, "travel maximum");
  }
  if (target > kPulsesMax || target < -kPulsesMax) {
    return on_axis(axis, {Reason::out_of_range,
                          fmt::format("{} would go to {} pulses; the controller counts to {}", label(profile, axis),
                                      target, kPulsesMax),
                          {},
                          {},
                          {},
                          {}});
  }
  return {};
}

Result<std::optional<std::int64_t>> speed_cap(int axis, const Profile& profile, const State& state) {
  const auto& cap = profile_of(profile, axis).maximum_speed;
  if (!cap) return std::optional<std::int64_t>();
  const auto pulses = to_pulses(*cap, *state.axis(axis).scale);
  if (!pulses) return on_axis(axis, pulses.error());
  return std::optional(*pulses);
}

Result<std::int64_t> checked_speed(const Quantity& speed, int axis, const Profile& profile, const State& state) {
  const auto pulses = to_pulses(speed, *state.axis(axis).scale);
  if (!pulses) return on_axis(axis, pulses.error());
  if (*pulses < 1 || *pulses > kSpeedMax) {
    return on_axis(axis, {Reason::out_of_range,
                          fmt::format("a speed of {} is {} pulses/s on {}; 1 to {} are possible",
                                      to_string(speed.value) + std::string(symbol(speed.unit)) + "/s", *pulses,
                                      label(profile, axis), kSpeedMax),
                          {},
                          {},
                          {},
                          {}});
  }
  const auto cap = speed_cap(axis, profile, state);
  if (!cap) return tl::unexpected(cap.error());
  if (*cap && *pulses > **cap) {
    return on_axis(axis, {Reason::too_fast,
                          fmt::format("{} may run at {}/s at most; {}/s were asked for", label(profile, axis),
                                      as_text(**cap, axis, profile, state), as_text(*pulses, axis, profile, state)),
                          "ask for a lower speed",
                          {},
                          {},
                          {}});
  }
  return *pulses;
}

// The speeds to send: those asked for, or the device's own where they exceed the configured maximum.
Result<std::optional<SpeedSetting>> plan_speed(const AxisMove& move, const Profile& profile, const State& state) {
  const auto& axis = state.axis(move.axis);
  if (move.profile) {
    const auto minimum = checked_speed(move.profile->minimum, move.axis, profile, state);
    if (!minimum) return tl::unexpected(minimum.error());
    const auto maximum = checked_speed(move.profile->maximum, move.axis, profile, state);
    if (!maximum) return tl::unexpected(maximum.error());
    const int time = move.profile->acceleration_ms;
    if (*minimum > *maximum || time < 1 || time > 1000) {
      return on_axis(move.axis, {Reason::out_of_range,
                                 fmt::format("{}: S {} must not exceed F {} pulses/s, and R is 1 to 1000 ms, not {}",
                                             label(profile, move.axis), *minimum, *maximum, time),
                                 {},
                                 {},
                                 {},
                                 {}});
    }
    return std::optional(SpeedSetting{*minimum, *maximum, time});
  }
  const auto cap = speed_cap(move.axis, profile, state);
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
Result<std::optional<SpeedSetting>> segment_speed(const Segment& segment, const MovePlan& move, const Profile& profile,
                                                  const State& state, const SpeedSetting& before) {
  const int axis = move.axes.front().axis;
  if (segment.acceleration_ms && (*segment.acceleration_ms < 1 || *segment.acceleration_ms > 1000)) {
    return on_axis(axis,
                   {Reason::out_of_range,
                    fmt::format("an acceleration time of {} ms; 1 to 1000 ms are possible", *segment.acceleration_ms),
                    {},
                    {},
                    {},
                    {}});
  }
  if (!segment.speed && !segment.acceleration_ms) return move.axes.front().speed;
  SpeedSetting speed = before;
  speed.acceleration_ms = segment.acceleration_ms.value_or(before.acceleration_ms);
  if (segment.speed) {
    const auto asked = checked_speed(*segment.speed, axis, profile, state);
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

Result<void> check_segment(const Segment& segment, const MovePlan& move, AxisSet axes, const State& state) {
  if (move.set() != axes) {
    return fail(Reason::invalid_request, "every segment of a path names the same axes",
                "repeat the axis with a distance of 0");
  }
  if (axes.count() > 1 && !segment.relative) {
    return fail(Reason::invalid_request, "a straight line is relative: the controller knows no absolute one (KP:)",
                "give the way instead of the target");
  }
  const auto& first = *state.axis(axes.lowest()).scale;
  const bool one_scale = std::ranges::all_of(axes.list(), [&](int axis) { return *state.axis(axis).scale == first; });
  if (!one_scale) {
    return fail(Reason::invalid_request, "a straight line needs axes whose pulses are equally long (manual 84) KP:)",
                "move these axes one after the other");
  }
  return {};
}

}  // namespace

AxisSet MovePlan::set() const {
  AxisSet axes_named;
  for (const auto& one : axes) axes_named.add(one.axis);
  return axes_named;
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
                           const Profile& profile, const State& state) {
  if (moves.empty()) return fail(Reason::invalid_request, "no axis was named", "name an axis and a distance");
  MovePlan plan{relative, {}};
  for (const AxisMove& move : moves) {
    if (auto good = check_axis(move.axis, profile, state); !good) return tl::unexpected(good.error());
    if (plan.set().has(move.axis)) {
      return on_axis(
          move.axis,
          {Reason::invalid_request, fmt::format("{} is named twice", label(profile, move.axis)), {}, {}, {}, {}});
    }
    const auto amount = to_pulses(move.distance, *state.axis(move.axis).scale);
    if (!amount) return on_axis(move.axis, amount.error());
    auto speed = plan_speed(move, profile, state);
    if (!speed) return tl::unexpected(speed.error());
    AxisPlan one{move.axis, *amount, {}, *speed};
    const auto& start = from[static_cast<std::size_t>(move.axis - 1)];
    if (!relative) one.target = *amount;
    if (relative && start) one.target = *start + *amount;
    if (one.target) {
      if (auto good = check_travel(move.axis, *one.target, profile, state); !good) return tl::unexpected(good.error());
    }
    plan.axes.push_back(one);
  }
  std::ranges::sort(plan.axes, {}, &AxisPlan::axis);
  return plan;
}

Result<PathPlan> plan_path(const PathRequest& request, const Positions& from, const Profile& profile,
                           const State& state) {
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
    auto move = plan_move(segment.moves, segment.relative, at, profile, state);
    if (!move) return in_segment(index, move.error());
    if (index == 0) {
      path.axes = move->set();
      speed = known_speed(state, path.axes.lowest());
    }
    if (auto good = check_segment(segment, *move, path.axes, state); !good) return in_segment(index, good.error());
    auto set = segment_speed(segment, *move, profile, state, speed);
    if (!set) return in_segment(index, set.error());
    for (auto& one : move->axes) one.speed.reset();
    move->axes.front().speed = *set;
    if (*set) speed = **set;

    SegmentPlan planned{*std::move(move), {}, {}, {}};
    std::vector<double> ways;
    for (const auto& one : planned.move.axes) {
      auto& position = at[static_cast<std::size_t>(one.axis - 1)];
      if (!position) {
        return on_axis(one.axis, {Reason::position_unknown,
                                  fmt::format("where {} stands is not known", label(profile, one.axis)),
                                  "wait until the device is up",
                                  {},
                                  {},
                                  {}});
      }
      ways.push_back(static_cast<double>(*one.target - *position));
      position = *one.target;
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
