// The travel envelope: the configured travel and speed limits of each axis for each caller, checked before anything is
// sent.
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

// The envelope of one caller at one moment. The profile and the state must outlive it.
class Envelope {
 public:
  // `role` is a role of the configuration, such as "operator"; with `who` it selects the overrides for the caller.
  Envelope(const Profile& profile, const State& state, std::string_view who, std::string_view role);

  // Fails with unknown_axis, with link_down, with position_unknown if the resolution is not known yet, or as
  // check_stage().
  Result<void> check_axis(int axis) const;
  // Fails with identity_mismatch if the resolution differs from the profile of the axis's stage. Checked at each motion
  // of the axis, since a request can change the resolution.
  Result<void> check_stage(int axis) const;
  // Fails with not_homed if the axis must home before any other motion.
  Result<void> check_homed(int axis) const;
  // Fails with outside_travel or out_of_range. Call this and all following functions only after check_axis() has
  // succeeded.
  Result<void> check_target(int axis, std::int64_t target_pulses) const;
  // Returns the last position that the axis may reach in that direction (1 or -1).
  Result<std::int64_t> bound(int axis, int direction) const;

  // Reports whether any travel limit or speed limit applies to the caller on this axis.
  bool is_bounded(int axis) const;

  // Converts a speed to pulses/s. Fails with out_of_range or too_fast, or as pulses().
  Result<std::int64_t> speed(int axis, const Quantity& asked) const;
  // Fails with too_fast.
  Result<void> check_speed(int axis, std::int64_t pulses_per_second) const;
  // Returns the highest speed allowed in pulses/s; nullopt if only the controller's own limit applies.
  Result<std::optional<std::int64_t>> speed_cap(int axis) const;

  // Converts a distance to pulses. Fails with unknown_unit, not_representable or out_of_range.
  Result<std::int64_t> pulses(int axis, const Quantity& distance) const;

  // Returns the error position_unknown, for a target that cannot be computed.
  tl::unexpected<Problem> position_unknown(int axis) const;

  const State& state() const { return state_; }
  std::string label(int axis) const;                         // "axis 1 (sample)"
  std::string as_text(int axis, std::int64_t pulses) const;  // "1.5mm", in the axis's display unit

 private:
  struct Bound {
    std::int64_t pulses = 0;
    std::string whose;  // `whose` of the override; empty: the general limit
  };
  // Returns the strictest limit that applies to the caller: the lowest, or the highest if `sign` is -1.
  Result<std::optional<Bound>> innermost(int axis, std::optional<Quantity> AxisLimits::*limit, int sign) const;
  std::vector<const LimitOverride*> overrides_for(int axis) const;
  const AxisProfile& profile(int axis) const { return profile_.axis(axis); }
  const Scale& scale(int axis) const { return *state_.axis(axis).scale; }

  const Profile& profile_;
  const State& state_;
  const std::string who_;
  const std::string role_;
};

// Returns a failure that concerns one axis.
tl::unexpected<Problem> fail_on(int axis, Reason reason, std::string message, std::string hint = {});

}  // namespace axisgate::stage
