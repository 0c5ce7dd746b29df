// Acts by hand, as bytes: what a person does with a mill besides jobs. The mill never says where its tool is, so steps
// are relative and short, and nothing checks where they lead.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Z upward.
struct JogStep {
  double x_mm = 0, y_mm = 0, z_mm = 0;
  std::optional<double> mm_per_s{};  // none: the default of Z's speeds
};

// Z0 of the jobs to come. X and Y are set at the mill's panel only.
struct SetSurface {
  std::optional<std::int64_t> at{};  // machine coordinate, in steps; none: where the tool is
};

struct TurnSpindle {
  bool on = false;
};

// To the top, with the spindle stopped.
struct RaiseTool {};

using HandAct = std::variant<JogStep, SetSurface, TurnSpindle, RaiseTool>;

// "jog by X 5 mm, Z -0.5 mm"; for the log and the journal.
std::string text_of(const HandAct& act);

struct HandWords {
  std::string bytes;
  Duration longest{};  // that it takes on the slowest mill of the profile
};

// `slack`: by how much a mill may be slower than the slowest of its profile (sending/README.md, "Streaming").
// out_of_range, where the step is too long or too short, or the height is outside of the travel; too_fast.
Result<HandWords> words_of(const HandAct& act, const Profile& profile, double slack);

// A step that leads into something does little damage, and the person sees it.
inline constexpr double kFarthestStepMm = 50, kDeepestStepMm = 5;

}  // namespace axisgate::rml1
