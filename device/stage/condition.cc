#include "device/stage/condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace axisgate::stage {
namespace {

struct Row {
  Condition condition;
  std::string_view name, begun, ended;
  bool reported = true;
};

// Positioning, origin returns, and the NEAR and ORG sensors change with every motion.
constexpr bool kInMotion = false;

constexpr std::array kRows = {
    Row{Condition::unnamed_error, "unnamed_error", "error without a name", "error without a name ended"},
    Row{Condition::scale_error, "scale_error", "scale error (S1)", "scale error (S1) ended"},
    Row{Condition::disconnection, "disconnection", "disconnection error (S2)", "disconnection error (S2) ended"},
    Row{Condition::overflow, "overflow", "overflow error (S4)", "overflow error (S4) ended"},
    Row{Condition::emergency_stop, "emergency_stop", "emergency stop", "emergency stop ended"},
    Row{Condition::hunting, "hunting", "hunting error (S3)", "hunting error (S3) ended"},
    Row{Condition::limit_error, "limit_error", "limit error (S5)", "limit error (S5) ended"},
    Row{Condition::counter_overflow, "counter_overflow", "counter overflow (S6)", "counter overflow (S6) ended"},
    Row{Condition::config_error, "config_error", "auto config error", "auto config error ended"},
    Row{Condition::io_overload, "io_overload", "24 V I/O overload (W1)", "24 V I/O overload (W1) ended"},
    Row{Condition::terminal_overload, "terminal_overload", "24 V terminal block overload (W2)",
        "24 V terminal block overload (W2) ended"},
    Row{Condition::system_error, "system_error", "system error (S7)", "system error (S7) ended"},
    Row{Condition::driver_hot, "driver_hot", "motor driver hot (W3)", "motor driver no longer hot (W3)"},
    Row{Condition::driver_too_hot, "driver_too_hot", "motor driver too hot (S10)", "motor driver too hot (S10) ended"},
    Row{Condition::out_of_position, "out_of_position", "out of position", "in position", kInMotion},
    Row{Condition::not_in_position, "not_in_position", "not in position yet", "in position", kInMotion},
    Row{Condition::returning_to_origin, "returning_to_origin", "returning to its origin", "origin return ended",
        kInMotion},
    Row{Condition::homing, "homing", "homing", "homing ended", kInMotion},
    Row{Condition::cw_limit, "cw_limit", "CW limit sensor on", "CW limit sensor off"},
    Row{Condition::ccw_limit, "ccw_limit", "CCW limit sensor on", "CCW limit sensor off"},
    Row{Condition::cw_software_limit, "cw_software_limit", "CW software limit", "CW software limit ended"},
    Row{Condition::ccw_software_limit, "ccw_software_limit", "CCW software limit", "CCW software limit ended"},
    Row{Condition::near_sensor, "near_sensor", "NEAR sensor on", "NEAR sensor off", kInMotion},
    Row{Condition::origin_sensor, "origin_sensor", "ORG sensor on", "ORG sensor off", kInMotion},
    Row{Condition::motor_off, "motor_off", "motor off", "motor on"},
    Row{Condition::mode, "mode", "mode", "mode"},
    Row{Condition::format, "format", "command format", "command format"},
};

constexpr auto kReported = [] {
  std::array<Condition, std::ranges::count(kRows, true, &Row::reported)> reported{};
  std::size_t count = 0;
  for (const Row& row : kRows) {
    if (row.reported) reported[count++] = row.condition;
  }
  return reported;
}();

const Row* row_of(Condition condition) {
  const auto* const row = std::ranges::find(kRows, condition, &Row::condition);
  return row == kRows.end() ? nullptr : row;
}

}  // namespace

std::string name(Condition condition) {
  const Row* const row = row_of(condition);
  return row ? std::string(row->name) : fmt::format("condition_{}", static_cast<int>(condition));
}

Condition condition_named(std::string_view name) {
  const auto* const row = std::ranges::find(kRows, name, &Row::name);
  return row == kRows.end() ? Condition{} : row->condition;
}

std::span<const Condition> reported_conditions() { return kReported; }

std::vector<Condition> listed(ConditionBits conditions) {
  std::vector<Condition> list;
  for (const Row& row : kRows) {
    if ((conditions & bit_of(row.condition)) != 0) list.push_back(row.condition);
  }
  return list;
}

std::string words(Condition condition) {
  const Row* const row = row_of(condition);
  return row ? std::string(row->begun) : name(condition);
}

std::string words(Condition condition, AxisSet axes, bool begun, std::string_view value) {
  if (condition == Condition::mode) return fmt::format("controller in {} mode{}", value, begun ? "" : " again");
  if (condition == Condition::format) return fmt::format("command format {}{}", value, begun ? "" : " again");
  const Row* const row = row_of(condition);
  if (row == nullptr) return fmt::format("{}: {} {}", to_string(axes), name(condition), begun ? "on" : "off");
  return fmt::format("{}: {}", to_string(axes), begun ? row->begun : row->ended);
}

}  // namespace axisgate::stage
