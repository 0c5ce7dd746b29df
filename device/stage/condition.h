// The conditions of a stage, which a person at the stage, a sensor or an error causes, and their names.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/stage/axes.h"

namespace axisgate::stage {

// Files and the API use the values, so they must never change.
enum class Condition {
  unnamed_error = 1,  // bit 1 is off, and no other bit explains it: S9, for instance
  scale_error = 3,
  disconnection = 4,
  overflow = 5,
  emergency_stop = 6,
  hunting = 7,
  limit_error = 8,
  counter_overflow = 9,
  config_error = 10,
  io_overload = 11,
  terminal_overload = 12,
  system_error = 13,
  driver_hot = 14,
  driver_too_hot = 15,
  out_of_position = 16,  // while READY
  not_in_position = 17,  // while BUSY
  returning_to_origin = 18,
  homing = 19,
  cw_limit = 20,
  ccw_limit = 21,
  cw_software_limit = 22,
  ccw_software_limit = 23,
  near_sensor = 24,
  origin_sensor = 25,
  motor_off = 30,
  mode = 31,    // not the mode for programs
  format = 32,  // not the command format that the gateway speaks
};

// Returns the name: "emergency_stop"; "condition_77" if the number has no name.
std::string name(Condition condition);
// Returns the condition with that name; Condition{} if there is none.
Condition condition_named(std::string_view name);

// Returns the conditions whose beginning and end are events: all but those that come and go with every motion.
std::span<const Condition> reported_conditions();

// A set of conditions: bit n - 1 is the condition with number n.
using ConditionBits = std::uint32_t;
constexpr ConditionBits bit_of(Condition condition) { return ConditionBits{1} << (static_cast<int>(condition) - 1); }
std::vector<Condition> listed(ConditionBits conditions);

// Describes the condition: "emergency stop", "CW limit sensor on".
std::string words(Condition condition);
// Describes the beginning or end of a condition: "axes 1 and 2: emergency stop", "axis 3: motor on", "controller in
// MANUAL mode". `value` is the mode or the command format.
std::string words(Condition condition, AxisSet axes, bool begun, std::string_view value);

}  // namespace axisgate::stage
