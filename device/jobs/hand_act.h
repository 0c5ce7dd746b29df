// Acts by hand: what a person does with a machine besides jobs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace axisgate::jobs {

// A JogStep moves the tool relative to its place; Z upward.
struct JogStep {
  double x_mm = 0, y_mm = 0, z_mm = 0;
  std::optional<double> mm_per_s{};  // nullopt: the machine's usual speed in Z
};

// Sets Z0 of later jobs. X and Y are set at the machine's panel only.
struct SetSurface {
  std::optional<std::int64_t> at{};  // machine coordinate, in steps; nullopt: where the tool is
};

struct TurnSpindle {
  bool on = false;
};

// Raises the tool to the top and stops the spindle.
struct RaiseTool {};

using HandAct = std::variant<JogStep, SetSurface, TurnSpindle, RaiseTool>;

// Returns "jog by X 5 mm, Z -0.5 mm", for the log and the journal.
std::string text_of(const HandAct& act);

}  // namespace axisgate::jobs
