#include "device/stage/envelope.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "device/core/guard.h"

namespace axisgate::stage {
namespace {

std::string for_whom(const std::string& whose) { return whose.empty() ? "" : fmt::format(" for {}", whose); }

}  // namespace

tl::unexpected<Problem> fail_on(int axis, Reason reason, std::string message, std::string hint) {
  return tl::unexpected<Problem>(
      Problem{.reason = reason, .message = std::move(message), .hint = std::move(hint), .axis = axis});
}

Envelope::Envelope(const Profile& profile, const State& state, std::string_view who, std::string_view role)
    : profile_(profile), state_(state), who_(who), role_(role) {}

Result<void> Envelope::check_axis(int axis) const {
  if (axis < 1 || axis > kAxesMax) {
    return fail(Reason::unknown_axis, fmt::format("there is no axis {}: a stage has at most {}", axis, kAxesMax));
  }
  if (state_.controllable().empty()) {
    return fail(Reason::link_down,
                "the device has not been up yet" + (state_.link_problem.empty() ? "" : ": " + state_.link_problem),
                "try again when it is up");
  }
  if (!state_.axis(axis).controllable) {
    return fail_on(axis, Reason::unknown_axis,
                   fmt::format("{} cannot be used: this unit has {}", label(axis), to_string(state_.controllable())),
                   "use one of its axes");
  }
  if (!state_.axis(axis).scale) {
    return fail_on(axis, Reason::position_unknown, fmt::format("{}: resolution unknown", label(axis)),
                   "wait until the device is up");
  }
  return check_stage(axis);
}

tl::unexpected<Problem> Envelope::position_unknown(int axis) const {
  return fail_on(axis, Reason::position_unknown, label(axis) + ": position unknown", "wait until the device is up");
}

Result<void> Envelope::check_stage(int axis) const {
  const auto& stage = profile(axis).stage;
  const auto& reported = state_.axis(axis).scale;
  if (!stage || !reported || *reported == stage->pulse || !guarded(Guard::stage_of_profile)) return {};
  return fail_on(
      axis, Reason::identity_mismatch,
      fmt::format("a pulse of {} is {} by the controller and {} by the profile of its stage, {}: "
                  "another stage is plugged in, the divisions were changed, or the profile is wrong",
                  label(axis), pulse_text(*reported), pulse_text(stage->pulse), stage->model),
      fmt::format(
          "plug in the {}, set divisions that make {} of a pulse (`ChangeSettings` with `divisions`), or correct "
          "the profile that the configuration names as the axis's stage",
          stage->model, pulse_text(stage->pulse)));
}

Result<void> Envelope::check_homed(int axis) const {
  bool first = profile(axis).require_homing;
  for (const LimitOverride* limits : overrides_for(axis)) first = first || limits->require_homing;
  if (!first || state_.axis(axis).homed || !guarded(Guard::homing_required)) return {};
  return fail_on(axis, Reason::not_homed,
                 fmt::format("{} has not found its origin since the controller was started, or was last out of sight: "
                             "its travel limits mean nothing yet",
                             label(axis)),
                 "home it first: `Home`");
}

Result<void> Envelope::check_target(int axis, std::int64_t target) const {
  for (const auto& [limit, sign, side] : {std::tuple{&AxisLimits::travel_minimum, -1, "minimum"},
                                          std::tuple{&AxisLimits::travel_maximum, 1, "maximum"}}) {
    const auto bound = innermost(axis, limit, sign);
    if (!bound) return tl::unexpected(bound.error());
    if (!*bound || sign * target <= sign * (*bound)->pulses || !guarded(Guard::travel_bounded)) continue;
    return fail_on(axis, Reason::outside_travel,
                   fmt::format("{} would go to {}, beyond its travel {} of {}{}", label(axis), as_text(axis, target),
                               side, as_text(axis, (*bound)->pulses), for_whom((*bound)->whose)),
                   "stay within the travel that the configuration allows");
  }
  if (target > kPulsesMax || target < -kPulsesMax) {
    return fail_on(
        axis, Reason::out_of_range,
        fmt::format("{} would go to {} pulses; the controller counts to {}", label(axis), target, kPulsesMax));
  }
  return {};
}

Result<std::int64_t> Envelope::bound(int axis, int direction) const {
  const auto limit =
      innermost(axis, direction < 0 ? &AxisLimits::travel_minimum : &AxisLimits::travel_maximum, direction);
  if (!limit) return tl::unexpected(limit.error());
  return *limit ? (*limit)->pulses : direction * kPulsesMax;
}

bool Envelope::is_bounded(int axis) const {
  const auto applies = [&](auto limit, int sign) {
    const auto one = innermost(axis, limit, sign);
    return !one || one->has_value();
  };
  return applies(&AxisLimits::travel_minimum, -1) || applies(&AxisLimits::travel_maximum, 1) ||
         applies(&AxisLimits::maximum_speed, 1);
}

Result<std::int64_t> Envelope::speed(int axis, const Quantity& asked) const {
  auto wanted = to_pulses_per_second(asked, scale(axis));
  if (!wanted) {
    wanted.error().axis = axis;
    return wanted;
  }
  if (*wanted < 1 || *wanted > profile_.speed_max) {
    return fail_on(axis, Reason::out_of_range,
                   fmt::format("a speed of {}{}/s is {} pulses/s on {}; 1 to {} are possible", to_string(asked.value),
                               symbol(asked.unit), *wanted, label(axis), profile_.speed_max));
  }
  if (const auto good = check_speed(axis, *wanted); !good) return tl::unexpected(good.error());
  return wanted;
}

Result<void> Envelope::check_speed(int axis, std::int64_t pulses_per_second) const {
  const auto cap = innermost(axis, &AxisLimits::maximum_speed, 1);
  if (!cap) return tl::unexpected(cap.error());
  if (!*cap || pulses_per_second <= (*cap)->pulses || !guarded(Guard::speed_bounded)) return {};
  return fail_on(axis, Reason::too_fast,
                 fmt::format("{} may run at {}/s at most{}, not at {}/s", label(axis), as_text(axis, (*cap)->pulses),
                             for_whom((*cap)->whose), as_text(axis, pulses_per_second)),
                 "ask for a lower speed");
}

Result<std::optional<std::int64_t>> Envelope::speed_cap(int axis) const {
  const auto cap = innermost(axis, &AxisLimits::maximum_speed, 1);
  if (!cap) return tl::unexpected(cap.error());
  return *cap ? std::optional(std::min((*cap)->pulses, profile_.speed_max)) : std::nullopt;
}

Result<std::int64_t> Envelope::pulses(int axis, const Quantity& distance) const {
  auto pulses = to_pulses(distance, scale(axis));
  if (!pulses) pulses.error().axis = axis;
  return pulses;
}

std::string Envelope::label(int axis) const {
  const std::string& name = profile(axis).name;
  return name.empty() ? fmt::format("axis {}", axis) : fmt::format("axis {} ({})", axis, name);
}

std::string Envelope::as_text(int axis, std::int64_t pulses) const {
  const Unit unit = profile(axis).unit;
  const auto value = from_pulses(pulses, unit, scale(axis));
  return value ? to_string(*value) + std::string(symbol(unit)) : fmt::format("{} pulses", pulses);
}

// Two limits may have different units, so each is converted to pulses before the comparison.
Result<std::optional<Envelope::Bound>> Envelope::innermost(int axis, std::optional<Quantity> AxisLimits::*limit,
                                                           int sign) const {
  std::optional<Bound> found;
  const auto take = [&](const AxisLimits& limits, const std::string& whose) -> Result<void> {
    if (!(limits.*limit)) return {};
    const bool speed = limit == &AxisLimits::maximum_speed;
    const Quantity& amount = *(limits.*limit);
    const auto here = speed ? to_pulses_per_second(amount, scale(axis)) : to_pulses(amount, scale(axis));
    if (!here) {
      const std::string_view key = speed ? "maximum_speed" : sign < 0 ? "travel_minimum" : "travel_maximum";
      return fail_on(axis, here.error().reason,
                     fmt::format("{} cannot be kept to its {}: {}", label(axis), key, here.error().message),
                     "have that changed in the configuration");
    }
    if (!found || sign * *here < sign * found->pulses) found = Bound{*here, whose};
    return {};
  };
  if (const auto good = take(profile(axis), ""); !good) return tl::unexpected(good.error());
  for (const LimitOverride* limits : overrides_for(axis)) {
    if (const auto good = take(*limits, limits->whose); !good) return tl::unexpected(good.error());
  }
  return found;
}

std::vector<const LimitOverride*> Envelope::overrides_for(int axis) const {
  std::vector<const LimitOverride*> theirs;
  for (const LimitOverride& limits : profile(axis).overrides) {
    const bool meant = limits.whose == who_ || limits.whose == role_;
    if (meant && guarded(Guard::overrides_for_some)) theirs.push_back(&limits);
  }
  return theirs;
}

}  // namespace axisgate::stage
