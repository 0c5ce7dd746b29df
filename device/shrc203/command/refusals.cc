#include "device/shrc203/command/refusals.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "device/shot/command/status.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {
namespace {

// Bits as numbered in manual 5) Q:S; manual 53) says which errors BEC: clears.
template <int kBit>
constexpr bool bit(const AxisState& axis) {
  return status_of(axis).bit(kBit);
}
bool busy(const AxisState& axis) { return axis.busy.value_or(false); }
bool off(const AxisState& axis) { return !axis.excited.value_or(true); }
bool at_limit(const AxisState& axis) { return status_of(axis).cw_limit() || status_of(axis).ccw_limit(); }

// Interpretation: an error prevents motion and the commands that prepare motion. Manual 5) only names the errors.
bool motion(const CommandRow& row) { return row.moves() || row.effect == Effect::motion_setting || row.needs.excited; }
bool ready(const CommandRow& row) { return row.needs.ready; }
bool excited(const CommandRow& row) { return row.needs.excited; }
bool no_limit(const CommandRow& row) { return row.needs.no_limit; }

constexpr std::string_view kClear = "clear it once it is safe: `ClearErrors`";
constexpr std::string_view kRestart =
    "remove its cause and restart the controller: `ResetDevice`, or power off and on; `ClearErrors` does not clear it";

constexpr AxisCondition kConditions[] = {
    {"emergency stop (bit 6)", bit<6>, motion, true, Reason::emergency_stopped, "is in emergency stop",
     "release the button, then clear it once it is safe: `ClearErrors`"},
    {"scale error S1 (bit 3)", bit<3>, motion, true, Reason::device_error, "shows a scale error (S1)", kRestart},
    {"disconnection error S2 (bit 4)", bit<4>, motion, true, Reason::device_error, "shows that its cable is off (S2)",
     kRestart},
    {"hunting error S3 (bit 7)", bit<7>, motion, true, Reason::device_error, "shows a hunting error (S3)", kRestart},
    {"overflow error S4 (bit 5)", bit<5>, motion, true, Reason::device_error, "shows an overflow error (S4)", kClear},
    {"limit error S5 (bit 8)", bit<8>, motion, true, Reason::limit_detected, "has met its limit",
     "clear it (`ClearErrors`), then move away from it"},
    {"counter overflow S6 (bit 9)", bit<9>, motion, true, Reason::device_error, "has counted beyond nine digits (S6)",
     "set another coordinate here: `SetCoordinates`"},
    {"auto config error (bit 10)", bit<10>, motion, true, Reason::device_error, "shows an auto config error", kRestart},
    {"system error S7 (bit 13)", bit<13>, motion, true, Reason::device_error, "shows a system error (S7)", kRestart},
    {"overheat error S10 (bit 15)", bit<15>, motion, true, Reason::device_error,
     "shows that its driver is too hot (S10)", "let it cool down, then restart the controller: `ResetDevice`"},
    {"busy", busy, ready, false, Reason::axis_busy, "is moving", "wait until it is stationary, or stop it: `Stop`"},
    {"excitation off", off, excited, false, Reason::not_excited, "has its motor off",
     "switch it on: `ChangeSettings` with `excited`"},
    {"limit sensor (bits 20, 21)", at_limit, no_limit, false, Reason::limit_detected, "is at its limit",
     "move it away from there by itself: `Move`"},
};

Problem reported(const AxisCondition& condition, int axis) {
  return {.reason = condition.reason,
          .message = fmt::format("axis {} {}", axis, condition.what),
          .hint = std::string(condition.hint),
          .axis = axis};
}

}  // namespace

std::span<const AxisCondition> axis_conditions() { return kConditions; }

std::optional<Problem> refusal_by(const CommandRow& row, AxisSet axes, const State& state) {
  for (const AxisCondition& condition : kConditions) {
    if (!condition.refuses(row)) continue;
    for (const int axis : axes.list()) {
      if (condition.shown(state.axis(axis))) return reported(condition, axis);
    }
  }
  return {};
}

std::optional<Problem> start_refused_by(AxisSet axes, const State& state) {
  return refusal_by(model().row("G:"), axes, state);
}

std::optional<Problem> busy_shown(AxisSet axes, const State& state) {
  return refusal_by(model().row("W:"), axes, state);
}

std::optional<Problem> error_shown(AxisSet axes, const State& state) {
  for (const AxisCondition& condition : kConditions) {
    for (const int axis : axes.list()) {
      if (condition.error && condition.shown(state.axis(axis))) return reported(condition, axis);
    }
  }
  return {};
}

Problem stale_setpoint(AxisSet axes) {
  return {.reason = Reason::stale_setpoint,
          .message =
              fmt::format("a stale prebuffer or jog setting is on {} and would run with the next start; no command is "
                          "documented to clear it",
                          to_string(axes)),
          .hint = "reset the controller (RESET: or power), then home it"};
}

Problem unexplained(std::string_view sent, AxisSet axes, const State& state) {
  std::string facts;
  for (const int number : axes.list()) {
    const AxisState& axis = state.axis(number);
    facts += fmt::format("; axis {} is {}, its motor is {}, status {:X}", number,
                         axis.busy.value_or(false) ? "BUSY" : "READY", axis.excited.value_or(true) ? "on" : "off",
                         axis.status_bits);
  }
  return {.reason = Reason::unexplained,
          .message = fmt::format(
              "the controller refused {} (NG), and nothing that it reports explains it: mode {}, format {}{}", sent,
              state.mode, state.format, facts),
          .hint = "compare its parameters with `ListCommands`, and check the controller's display",
          .sent = std::string(sent),
          .wire_reply = "NG"};
}

}  // namespace axisgate::shrc203
