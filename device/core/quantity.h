// Exact decimals with units. Positions are whole pulses; what cannot be represented is refused, never rounded.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate {

enum class Unit { pulses, nanometers, micrometers, millimeters, degrees };

// "pulse", "nm", "um", "mm", "deg".
std::string_view symbol(Unit unit);

// Accepts the symbols above and the spellings people use: p, pls, pulses, µm, degree, degrees, °. Otherwise
// unknown_unit.
Result<Unit> parse_unit(std::string_view text);

// value = digits * 10^-decimals, with at most 18 digits and decimals from 0 to 18.
struct Decimal {
  std::int64_t digits = 0;
  int decimals = 0;

  friend bool operator==(const Decimal&, const Decimal&) = default;
};

// An optional sign, digits, one optional point with digits after it. No exponent, no blanks. Zeros at the end of the
// fraction are dropped, so that equal numbers compare equal. Otherwise invalid_request, or out_of_range for a number
// that does not fit a Decimal.
Result<Decimal> parse_decimal(std::string_view text);
std::string to_string(Decimal value);

// A distance or a position; as a speed, the same per second.
struct Quantity {
  Decimal value;
  Unit unit = Unit::pulses;
};

// A number and its unit without blanks: "5mm", "-200um", "+1000". Without a unit `fallback` is taken. parse_speed takes
// "2mm/s", "2mm" or "2"; parse_quantity refuses a "/s".
Result<Quantity> parse_quantity(std::string_view text, Unit fallback);
Result<Quantity> parse_speed(std::string_view text, Unit fallback);

inline Quantity pulses(std::int64_t count) { return {{count, 0}, Unit::pulses}; }

// What one pulse is (manual 10) ?:P, in nanometres; for a rotary axis, in millionths of a degree).
struct Scale {
  Decimal per_pulse = {1, 0};
  bool rotary = false;

  friend bool operator==(const Scale&, const Scale&) = default;
};
std::string pulse_text(const Scale& scale);  // "10 nm", "0.0025 deg"

// The scale of which one pulse is that way, exactly; rotary for degrees. invalid_request for a way in pulses or not
// above zero, out_of_range when it does not fit a Decimal.
Result<Scale> scale_of(const Quantity& pulse);

// The most that a command carries either way (manual 67) M:).
inline constexpr std::int64_t kPulsesMax = 999'999'999;

// Whole pulses, exactly. Otherwise not_representable, naming the nearest representable values; out_of_range beyond
// +-kPulsesMax; unknown_unit for degrees on a linear axis and lengths on a rotary one; device_error when the scale is
// not above zero. A scale is not looked at for a quantity in pulses.
Result<std::int64_t> to_pulses(const Quantity& quantity, const Scale& scale);

// The same of a speed, in whole pulses per second; messages are of speeds.
Result<std::int64_t> to_pulses_per_second(const Quantity& speed, const Scale& scale);

// Exactly; e.g. 500000 pulses of 10 nm are "5" mm. Zeros at the end of the fraction are dropped. Otherwise unknown_unit
// and device_error as above, or out_of_range when it does not fit a Decimal.
Result<Decimal> from_pulses(std::int64_t pulses, Unit unit, const Scale& scale);

// Where in its turn an axis is that has turned so far: degrees from 0 up to, and not including, `turn`, which is above
// zero. Exactly; otherwise as from_pulses().
Result<Decimal> within_turn(std::int64_t pulses, const Decimal& turn, const Scale& scale);

}  // namespace axisgate
