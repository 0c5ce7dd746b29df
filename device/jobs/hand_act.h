// Acts by hand: operations of a machine that a person requests while no job runs.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "device/core/quantity.h"

namespace axisgate::jobs {

// A JogStep moves the tool relative to its present position; positive Z is up.
struct JogStep {
  Quantity x{}, y{}, z{};           // a pulse is a step of the machine's coordinates
  std::optional<Quantity> speed{};  // nullopt: the machine's default speed in Z
};

// Sets Z0 for later jobs. X and Y can be set only at the machine's panel.
struct SetZ0 {
  std::optional<Quantity> at{};  // machine coordinate; nullopt: the present height of the tool
};

struct TurnSpindle {
  bool on = false;
};

// Raises the tool to the top and stops the spindle.
struct RaiseTool {};

using HandAct = std::variant<JogStep, SetZ0, TurnSpindle, RaiseTool>;

// Returns the act as text for the log and the journal: "jog by X 5 mm, Z -0.5 mm".
std::string text_of(const HandAct& act);

}  // namespace axisgate::jobs
