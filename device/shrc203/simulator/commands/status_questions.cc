#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "device/shrc203/simulator/commands/questions.h"

namespace axisgate::shrc203::simulator {
namespace {

// Bits numbered from 1, as in the manual (manual 5) Q:S).
enum StatusBit {
  kNormal = 1,
  kCommandError = 2,
  kEmergency = 6,
  kLimitError = 8,
  kCounterOverflow = 9,
  kOutOfPositionWhenReady = 16,
  kOutOfPositionWhenBusy = 17,
  kLogicalReturn = 18,
  kOriginReturn = 19,
  kPlusLimit = 20,
  kMinusLimit = 21,
  kOriginSensor = 25,
};

constexpr std::uint32_t kAllBits = 0x1FFFFFF;

// Largest coordinate that the counter shows: nine digits and a sign.
constexpr std::int64_t kCounterMax = 999'999'999;

bool counter_overflows(const Rig& rig, int axis) { return std::abs(rig.axis(axis).coordinate(rig.now)) > kCounterMax; }

std::uint32_t status_of(const Rig& rig, int number) {
  const Axis& axis = rig.axis(number);
  std::uint32_t status = (axis.errors.raw() | axis.flags.raw()) & kAllBits;
  const auto raise = [&status](StatusBit bit, bool on) {
    const std::uint32_t mask = 1u << (bit - 1);
    status = on ? status | mask : status & ~mask;
  };
  const bool hidden = rig.command_error && rig.options.is("command_error_status", "normal_clears");
  const bool overflows = counter_overflows(rig, number);
  raise(kNormal, !axis.error_stop() && !axis.limit_error && !overflows && !hidden);
  raise(kCommandError, rig.command_error);
  raise(kEmergency, axis.emergency);
  raise(kLimitError, axis.limit_error);
  raise(kCounterOverflow, overflows);
  const bool out_of_position = axis.flags.has(AxisFlag::out_of_position), busy = rig.motions.busy(number);
  raise(kOutOfPositionWhenReady, out_of_position && !busy);
  raise(kOutOfPositionWhenBusy, out_of_position && busy);
  raise(kLogicalReturn, rig.motions.returning(number, Kind::logical_return));
  raise(kOriginReturn, rig.motions.returning(number, Kind::origin_return));
  raise(kPlusLimit, axis.limit_sensor(1, rig.now));
  raise(kMinusLimit, axis.limit_sensor(-1, rig.now));
  raise(kOriginSensor, axis.origin_sensor(rig.now));
  return status;
}

std::string ready_or_busy(bool busy) { return busy ? "B" : "R"; }

std::string ready_fields(const Rig& rig, const Axes& axes) {
  return join_fields(axes, [&](int axis) { return ready_or_busy(rig.motions.busy(axis)); });
}

std::string status_fields(const Rig& rig, const Axes& axes) {
  return join_fields(axes, [&](int axis) { return fmt::format("{:X}", status_of(rig, axis)); });
}

// The e,s,r of Q: and SRQ: (manual 4), 6)).
std::string summary(const Rig& rig) {
  Axes at_limit;
  bool error = false;
  for (const int axis : rig.controllable.list()) {
    if (rig.axis(axis).limit_error) at_limit.add(axis);
    error = error || rig.axis(axis).error_stop() || counter_overflows(rig, axis);
  }
  const char status = error ? 'R' : at_limit.empty() ? 'K' : limit_stop_letter(at_limit);
  return fmt::format("{},{},{}", rig.command_error ? 'X' : 'K', status,
                     ready_or_busy(rig.motions.busy(rig.controllable)));
}

// Ten characters: the sign on the left, the digits on the right (manual 4) Q:).
std::string fixed_coordinate(const Rig& rig, int axis) {
  const std::int64_t value = rig.controllable.has(axis) ? rig.axis(axis).coordinate(rig.now) : 0;
  return fmt::format("{}{:>9}", value < 0 ? '-' : '+', std::min(std::abs(value), kCounterMax));
}

std::string unit_coordinate(const Rig& rig, int number, char named_unit) {
  const Axis& axis = rig.axis(number);
  const char unit = named_unit == '\0' ? axis.unit : named_unit;
  const std::int64_t value = axis.coordinate(rig.now);
  if (rig.options.is("q_s_sign", "bare")) return unit + from_pulses_by_resolution(value, unit, axis.pitch());
  return fmt::format("{}{}{}", unit, value < 0 ? "" : "+", from_pulses(value, unit, axis.pitch()));
}

// The memory switch STAGE UNIT decides if no unit is given. Both counters agree on a simulated stage.
std::optional<std::string> answer_coordinates(const Rig& rig, Reader reader) {
  char unit = '\0';
  for (const char candidate : {'N', 'U', 'M', 'D', 'P'}) {
    if (reader.take(candidate)) {
      unit = candidate;
      break;
    }
  }
  if (!reader.take('E')) reader.take('C');
  if (!reader.done()) return std::nullopt;
  const bool left_out = rig.options.is("invalid_axis_fields", "left_out");
  const Axes shown = left_out ? rig.controllable : Axes{1, 2, 3};
  const auto valid_or = [&](int axis, std::string valid, std::string invalid) {
    return rig.controllable.has(axis) ? std::move(valid) : std::move(invalid);
  };
  return join_fields(shown, [&](int axis) { return valid_or(axis, unit_coordinate(rig, axis, unit), "0"); }) + ',' +
         join_fields(shown, [&](int axis) { return valid_or(axis, status_fields(rig, {axis}), "0"); }) + ',' +
         join_fields(shown, [&](int axis) { return valid_or(axis, ready_fields(rig, {axis}), "D"); });
}

std::optional<std::string> answer_detailed_status(const Rig& rig, const Axes& axes, bool all) {
  if (!all || !rig.options.is("invalid_axis_fields", "three_fields_everywhere")) {
    return status_fields(rig, axes) + ',' + ready_fields(rig, axes);
  }
  const auto valid_or = [&](int axis, std::string valid, std::string invalid) {
    return rig.controllable.has(axis) ? std::move(valid) : std::move(invalid);
  };
  const Axes three{1, 2, 3};
  return join_fields(three, [&](int axis) { return valid_or(axis, status_fields(rig, {axis}), "0"); }) + ',' +
         join_fields(three, [&](int axis) { return valid_or(axis, ready_fields(rig, {axis}), "D"); });
}

// Reads the `aS` after !: and SRQ:, and returns its axes.
std::optional<Axes> take_axes_and_s(const Rig& rig, Reader& reader) {
  if (reader.rest() == "S") return rig.controllable;
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || reader.rest() != "S") return std::nullopt;
  return axes;
}

}  // namespace

std::optional<std::string> answer_status(const Rig& rig, std::string_view line) {
  Reader reader(line);
  if (reader.take('!')) {
    const bool colon = reader.take(':');
    if (reader.done()) return colon ? std::optional(ready_or_busy(rig.motions.busy(rig.controllable))) : std::nullopt;
    const auto axes = take_axes_and_s(rig, reader);
    return axes ? std::optional(ready_fields(rig, *axes)) : std::nullopt;
  }
  if (reader.take_text("Q:")) {
    if (reader.take('S')) return answer_coordinates(rig, reader);
    if (!reader.done()) return std::nullopt;
    const bool left_out = rig.options.is("invalid_axis_fields", "left_out");
    const Axes shown = left_out ? rig.controllable : Axes{1, 2, 3};
    return join_fields(shown, [&](int axis) { return fixed_coordinate(rig, axis); }) + ',' + summary(rig);
  }
  if (!reader.take_text("SRQ:")) return std::nullopt;
  if (reader.done()) return summary(rig);
  const bool all = reader.rest() == "S" || reader.rest() == "WS";
  const auto axes = take_axes_and_s(rig, reader);
  return axes ? answer_detailed_status(rig, *axes, all) : std::nullopt;
}

std::optional<std::string> answer_in_hit_format(const Rig& rig, std::string_view line) {
  if (line == "!:") {
    return join_fields(rig.controllable, [&](int axis) { return std::string(rig.motions.busy(axis) ? "1" : "0"); });
  }
  if (line == "Q:") {
    return join_fields(rig.controllable, [&](int axis) { return std::to_string(rig.axis(axis).coordinate(rig.now)); });
  }
  return std::nullopt;
}

}  // namespace axisgate::shrc203::simulator
