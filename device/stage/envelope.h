// How far and how fast a caller may move each axis: the travel envelope of the configuration, checked before anything
// is sent.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/stage/profile.h"
#include "device/stage/state.h"

namespace axisgate::stage {

inline constexpr std::int64_t kSpeedMax = 1'000'000;  // pulses/s (manual 89) D:)

// Of one caller, at one moment. Both others outlive it.
class Envelope {
 public:
  // `role` is a word of the configuration, "operator"; with `who` it chooses the overrides of the caller.
  Envelope(const Profile& profile, const State& state, std::string_view who, std::string_view role);

  // unknown_axis, link_down, position_unknown where nothing can be converted yet, or as check_stage().
  Result<void> check_axis(int axis) const;
  // identity_mismatch, where a pulse is not what the profile of the axis's stage says. Looked at whenever the axis is
  // to move, since S: makes another way of it (manual 55)).
  Result<void> check_stage(int axis) const;
  // not_homed, where the axis must have found its origin before it moves otherwise.
  Result<void> check_homed(int axis) const;
  // outside_travel, out_of_range. Of an axis that check_axis() passed, as all that follows.
  Result<void> check_target(int axis, std::int64_t target_pulses) const;
  // The furthest that the axis may go in that direction (1 or -1).
  Result<std::int64_t> bound(int axis, int direction) const;

  // Whether any travel limit or speed cap applies to the caller there.
  bool is_bounded(int axis) const;

  // Pulses per second: out_of_range, too_fast.
  Result<std::int64_t> speed(int axis, const Quantity& asked) const;
  // too_fast.
  Result<void> check_speed(int axis, std::int64_t pulses_per_second) const;
  // Nothing where the controller's own limit is the only one.
  Result<std::optional<std::int64_t>> speed_cap(int axis) const;

  // unknown_unit, not_representable, out_of_range.
  Result<std::int64_t> pulses(int axis, const Quantity& distance) const;

  // What is answered where a target cannot be computed: position_unknown.
  tl::unexpected<Problem> position_unknown(int axis) const;

  const State& state() const { return state_; }
  std::string label(int axis) const;                         // "axis 1 (sample)"
  std::string as_text(int axis, std::int64_t pulses) const;  // "1.5mm", as the axis is shown

 private:
  struct Bound {
    std::int64_t pulses = 0;
    std::string whose;  // of the override; empty: everybody's
  };
  // The innermost of those that apply to the caller: the lowest, or with -1 the highest.
  Result<std::optional<Bound>> innermost(int axis, std::optional<Quantity> AxisLimits::*limit, int sign) const;
  std::vector<const LimitOverride*> overrides_for(int axis) const;
  const AxisProfile& profile(int axis) const { return profile_.axes[static_cast<std::size_t>(axis - 1)]; }
  const Scale& scale(int axis) const { return *state_.axis(axis).scale; }

  const Profile& profile_;
  const State& state_;
  const std::string who_;
  const std::string role_;
};

// A refusal that means one axis.
tl::unexpected<Problem> fail_on(int axis, Reason reason, std::string message, std::string hint = {});

}  // namespace axisgate::stage
