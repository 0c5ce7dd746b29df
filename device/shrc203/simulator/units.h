// Numbers as clients write them, and their conversion to whole pulses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::shrc203::simulator {

inline constexpr std::int64_t kSpeedMax = 1'000'000;  // S and F: pulses/s, manual 89)
inline constexpr std::int64_t kRampMax = 1000;        // R: ms, manual 89)

// Value: digits * 10^-decimals, exactly.
struct Number {
  std::int64_t digits = 0;
  int decimals = 0;
};

// Size of one pulse (manual 10) ?:P): BASE RATE * 10 / DIVIDE, where DIVIDE is the division number of the motor driver.
// `nanometers_e6` is BASE RATE * 10 in millionths of a nanometre.
struct Pitch {
  std::int64_t nanometers_e6 = 0;
  std::int64_t divide = 1;
};

// Reports whether the letter is a unit: P or F pulses, N nm, U um, M mm, D degrees. A degree counts as a million
// nanometres: the manual equates one pulse of 1 nm with 0.000001 degree (manual 14), 67)).
bool is_unit(char letter);

enum class Fraction { round, truncate, refuse };

// Converts to whole pulses; nullopt if a fraction is refused or the result is too large.
std::optional<std::int64_t> to_pulses(Number number, char unit, Pitch pitch, Fraction fraction);

// Returns the shortest text, with at most nine decimals and no plus sign: "0.01", "-1000".
std::string from_pulses(std::int64_t pulses, char unit, Pitch pitch);

// Returns a text with as many decimals as one pulse has: "0.00" for a pulse of 0.01 um.
std::string from_pulses_by_resolution(std::int64_t pulses, char unit, Pitch pitch);

// Returns the exact value, without trailing zeros.
std::string to_text(Number number);

}  // namespace axisgate::shrc203::simulator
