// Why the controller answers NG: one table from what an axis shows to the reason and to what helps.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "device/core/problem.h"
#include "device/shrc203/command/axes.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// What an axis may show, and which commands are refused then.
struct AxisCondition {
  std::string_view name;  // "emergency stop", as tables show it
  bool (*shown)(const AxisState& axis);
  bool (*refuses)(const CommandRow& row);
  bool error = false;  // a motion that meets it has not ended well
  Reason reason = Reason::unspecified;
  std::string_view what;  // "axis 1 ..."
  std::string_view hint;  // {} is the axis
};

// In the order in which they are looked for: the first that is shown is reported.
std::span<const AxisCondition> axis_conditions();

// The first axis, and what it shows, that stands against the command.
std::optional<Problem> refusal_by(const CommandRow& row, AxisSet axes, const State& state);

// Likewise against a start, and against whatever needs READY and nothing else.
std::optional<Problem> start_refused_by(AxisSet axes, const State& state);
std::optional<Problem> busy_shown(AxisSet axes, const State& state);

// The first error that one of the axes shows, whatever is asked of it.
std::optional<Problem> error_shown(AxisSet axes, const State& state);

// Of what somebody has set on these axes and never started, and no command deletes.
Problem stale_setpoint(AxisSet axes);

// For a refusal that nothing explains: the known facts. `sent` is the line.
Problem unexplained(std::string_view sent, AxisSet axes, const State& state);

}  // namespace axisgate::shrc203
