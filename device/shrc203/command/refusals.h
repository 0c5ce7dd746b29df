// Reasons for which the controller answers NG: one table from the status of an axis to the reason and the remedy.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "device/core/problem.h"
#include "device/shot/command/axes.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// A condition that an axis may show, and the commands that the controller refuses then.
struct AxisCondition {
  std::string_view name;  // "emergency stop", as shown in tables
  bool (*shown)(const AxisState& axis);
  bool (*refuses)(const CommandRow& row);
  bool error = false;  // a motion that meets the condition has not ended successfully
  Reason reason = Reason::unspecified;
  std::string_view what;  // "axis 1 ..."
  std::string_view hint;  // {}: number of the axis
};

// Returns the conditions in order of priority: the first one shown is reported.
std::span<const AxisCondition> axis_conditions();

// Returns the first condition that prevents the command, with its axis.
std::optional<Problem> refusal_by(const CommandRow& row, AxisSet axes, const State& state);

// Return the same for a start, and for a command that needs only READY.
std::optional<Problem> start_refused_by(AxisSet axes, const State& state);
std::optional<Problem> busy_shown(AxisSet axes, const State& state);

// Returns the first error that one of the axes shows, for any command.
std::optional<Problem> error_shown(AxisSet axes, const State& state);

// Returns the problem of a setting that was never started on these axes and that no command deletes.
Problem stale_setpoint(AxisSet axes);

// Returns the known facts for a refusal without an explanation. `sent` is the line.
Problem unexplained(std::string_view sent, AxisSet axes, const State& state);

}  // namespace axisgate::shrc203
