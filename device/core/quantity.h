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

// Accepts the symbols above and the spellings people use: p, pulses, µm, degree, degrees, °.
Result<Unit> parse_unit(std::string_view text);

// value = digits * 10^-decimals. At most 18 digits.
struct Decimal {
  std::int64_t digits = 0;
  int decimals = 0;

  friend bool operator==(const Decimal&, const Decimal&) = default;
};

// Sign, digits, one optional point. No exponent, no blanks.
Result<Decimal> parse_decimal(std::string_view text);
std::string to_string(Decimal value);

// A distance or a position; as a speed, the same per second.
struct Quantity {
  Decimal value;
  Unit unit = Unit::pulses;
};

// "5mm", "-200um", "+1000", "2mm/s" (the "/s" must then be present in both or in neither of the uses it is compared in;
// parse_speed requires nothing but tolerates it). Without a unit `fallback` is taken.
Result<Quantity> parse_quantity(std::string_view text, Unit fallback);
Result<Quantity> parse_speed(std::string_view text, Unit fallback);

inline Quantity pulses(std::int64_t count) { return {{count, 0}, Unit::pulses}; }

// What one pulse is (manual 10) ?:P, in nanometres; for a rotary axis, in millionths of a degree).
struct Scale {
  Decimal per_pulse = {1, 0};
  bool rotary = false;

  friend bool operator==(const Scale&, const Scale&) = default;
};

// Whole pulses, exactly. not_representable names the nearest representable values; unknown_unit is returned for
// degrees on a linear axis and lengths on a rotary one.
Result<std::int64_t> to_pulses(const Quantity& quantity, const Scale& scale);

// Exactly; e.g. 500000 pulses of 10 nm are "5" mm. Trailing zeros are dropped.
Result<Decimal> from_pulses(std::int64_t pulses, Unit unit, const Scale& scale);

}  // namespace axisgate
