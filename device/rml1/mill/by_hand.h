// Acts by hand, as bytes: what a person does with a mill besides jobs. The mill never says where its tool is, so steps
// are relative and short, and nothing checks where they lead.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/jobs/hand_act.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

struct HandWords {
  std::string bytes;
  Duration longest{};  // that it takes on the slowest mill of the profile
};

// `slack`: by how much a mill may be slower than the slowest of its profile (sending/README.md, "Streaming").
// out_of_range, where the step is too long or too short, or the height is outside of the travel; too_fast.
Result<HandWords> words_of(const jobs::HandAct& act, const Profile& profile, double slack);

// A step that leads into something does little damage, and the person sees it.
inline constexpr double kFarthestStepMm = 50, kDeepestStepMm = 5;

}  // namespace axisgate::rml1
