// Commands for acts by hand. A mill never reports the position of its tool, so steps are relative and short, and their
// targets are not checked.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/jobs/hand_act.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

struct HandCommands {
  std::string bytes;
  Duration longest{};  // longest time to execute the bytes, with the slack of words_of()
};

// Returns the commands for an act. `slack`: factor by which a mill may be slower than the slowest mill of its profile
// (sending/README.md, "Streaming"). Fails with out_of_range if a step is too long or too short, or if a height is
// outside of Z's travel. Fails with too_fast if the profile does not allow the speed of a step.
Result<HandCommands> words_of(const jobs::HandAct& act, const Profile& profile, double slack);

// Longest step along an axis, and longest step down. If such a short step hits an obstacle, the damage is small and the
// person sees it.
inline constexpr double kFarthestStepMm = 50, kDeepestStepMm = 5;

}  // namespace axisgate::rml1
