// The trigger output (manual 97) to 101)): one setting per controller, told by ?:T (manual 42)).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "device/shrc203/codec.h"

namespace axisgate::shrc203 {

struct Trigger {
  enum class Target { none, drive_pulses, timer, scale_plus, scale_minus };
  Target target = Target::none;
  int axis = 0;               // 1 to 3; 0 for a timer and for none
  std::int64_t interval = 0;  // 2 to 30,000 pulses; 1 to 10,000 times 0.01 s for a timer

  friend bool operator==(const Trigger&, const Trigger&) = default;
};

// The answer to ?:T: NS, or m,v or m,a,v; nothing where it is none. A sign of v says what m says already.
std::optional<Trigger> parse_trigger(std::string_view answer);

// The line that sets it.
Command trigger_command(const Trigger& trigger);

// What an accepted line of T: sets; nothing for any other, and for T:M, which fires once and sets nothing.
std::optional<Trigger> trigger_of(const Command& command);

}  // namespace axisgate::shrc203
