#include "device/shrc203/planning/plan.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::shrc203 {

Result<void> check_acceleration(int axis, int milliseconds) {
  if (milliseconds >= 1 && milliseconds <= 1000) return {};
  return fail_on(axis, Reason::out_of_range,
                 fmt::format("an acceleration time of {} ms; 1 to 1000 ms are possible", milliseconds));
}

namespace {

// Returns the speeds to send: the requested ones, or a reduced profile if the device's own speed exceeds the caller's
// limit.
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

}  // namespace

AxisSet MovePlan::set() const {
  AxisSet axes_named;
  for (const auto& one : axes) axes_named.add(one.axis);
  return axes_named;
}

std::map<int, std::int64_t> amounts_of(const MovePlan& plan) {
  std::map<int, std::int64_t> amounts;
  for (const auto& axis : plan.axes) amounts[axis.axis] = axis.amount;
  return amounts;
}

std::map<int, SpeedSetting> speeds_of(const MovePlan& plan) {
  std::map<int, SpeedSetting> speeds;
  for (const auto& axis : plan.axes) {
    if (axis.speed) speeds[axis.axis] = *axis.speed;
  }
  return speeds;
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

}  // namespace axisgate::shrc203
