// Numbers as clients write them, and what they are in whole pulses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::shrc203::simulator {

inline constexpr std::int64_t kSpeedMax = 1'000'000;  // S and F: pulses/s, manual 89)
inline constexpr std::int64_t kRampMax = 1000;        // R: ms, manual 89)

// digits * 10^-decimals, exactly.
struct Number {
  std::int64_t digits = 0;
  int decimals = 0;
};

// What one pulse is (manual 10) ?:P): BASE RATE * 10 / DIVIDE, where DIVIDE is the motor driver's division number.
// `nanometers_e6` is BASE RATE * 10 in millionths of a nanometre.
struct Pitch {
  std::int64_t nanometers_e6 = 0;
  std::int64_t divide = 1;
};

// A unit letter: P or F pulses, N nm, U um, M mm, D degrees. A degree is a million times what a nanometre is: the
// manual counts one pulse of 1 nm as one of 0.000001 degree (manual 14), 67)).
bool is_unit(char letter);

enum class Fraction { round, truncate, refuse };

// Whole pulses; nothing when the fraction is refused or the amount is beyond all ranges.
std::optional<std::int64_t> to_pulses(Number number, char unit, Pitch pitch, Fraction fraction);

// The shortest text, at most nine decimals, no sign for a positive one: "0.01", "-1000".
std::string from_pulses(std::int64_t pulses, char unit, Pitch pitch);

// The same with as many decimals as one pulse has: "0.00" for a pulse of 0.01 um.
std::string from_pulses_by_resolution(std::int64_t pulses, char unit, Pitch pitch);

// Exactly, without trailing zeros.
std::string to_text(Number number);

}  // namespace axisgate::shrc203::simulator
