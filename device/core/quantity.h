// Exact decimals with units. Positions are whole pulses; a value that is not a whole number of pulses is refused,
// unless rounding was requested.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate {

enum class Unit { pulses, nanometers, micrometers, millimeters, degrees };

// "pulse", "nm", "um", "mm", "deg".
std::string_view symbol(Unit unit);

// Accepts the symbols above and other common spellings: p, pls, pulses, µm, degree, degrees, °. Fails with unknown_unit
// otherwise.
Result<Unit> parse_unit(std::string_view text);

// value = digits * 10^-decimals, with at most 18 digits and decimals from 0 to 18.
struct Decimal {
  std::int64_t digits = 0;
  int decimals = 0;

  friend bool operator==(const Decimal&, const Decimal&) = default;
};

// Reads an optional sign, digits, an optional point with digits after it, and an optional exponent ("e-3"); no blanks.
// Zeros at the end of the fraction are dropped, so that equal numbers compare equal. Fails with out_of_range if the
// number does not fit a Decimal, and with invalid_request if the text is not a number.
Result<Decimal> parse_decimal(std::string_view text);
std::string to_string(Decimal value);
// Returns the shortest decimal that reads back as `value`, or with `approximate` one within 10^-15 of it. Fails with
// invalid_request if the value is not finite, and otherwise like parse_decimal().
Result<Decimal> decimal_of(double value, bool approximate);

// A distance or a position. As a speed: the distance per second.
struct Quantity {
  Decimal value;
  Unit unit = Unit::pulses;
  bool nearest = false;  // to_pulses() rounds to the nearest pulse instead of refusing
};

// Read a number and its unit without blanks: "5mm", "-200um", "+1000". If there is no unit, `fallback` is used.
// parse_speed accepts "2mm/s", "2mm" or "2"; parse_quantity refuses a "/s".
Result<Quantity> parse_quantity(std::string_view text, Unit fallback);
Result<Quantity> parse_speed(std::string_view text, Unit fallback);

inline Quantity pulses(std::int64_t count) { return {.value = {count, 0}}; }

// Size of one pulse (manual 10) ?:P) in nanometres; for a rotary axis, in millionths of a degree.
struct Scale {
  Decimal per_pulse = {1, 0};
  bool rotary = false;

  friend bool operator==(const Scale&, const Scale&) = default;
};
std::string pulse_text(const Scale& scale);  // "10 nm", "0.0025 deg"

// Returns the scale whose pulse is exactly `pulse`; rotary for degrees. Fails with invalid_request if `pulse` is in
// pulses or not above zero, and with out_of_range if it does not fit a Decimal.
Result<Scale> scale_of(const Quantity& pulse);

// Maximum number of pulses that a command carries in each direction (manual 67) M:).
inline constexpr std::int64_t kPulsesMax = 999'999'999;

// Returns the number of whole pulses; half a pulse is rounded away from 0, if the quantity is rounded. The scale is not
// used for a quantity in pulses. Fails with not_representable if the quantity is not a whole number of pulses and not
// rounded; the message names the nearest representable values. Fails with out_of_range beyond +-kPulsesMax. Fails with
// unknown_unit for degrees on a linear axis and for lengths on a rotary one. Fails with device_error if the scale is
// not above zero.
Result<std::int64_t> to_pulses(const Quantity& quantity, const Scale& scale);

// Converts a speed to whole pulses per second in the same way; messages speak of speeds.
Result<std::int64_t> to_pulses_per_second(const Quantity& speed, const Scale& scale);

// Returns the exact value: 500000 pulses of 10 nm are "5" mm. Zeros at the end of the fraction are dropped. Fails with
// unknown_unit and device_error like to_pulses(), and with out_of_range if the value does not fit a Decimal.
Result<Decimal> from_pulses(std::int64_t pulses, Unit unit, const Scale& scale);

// Returns the exact angle of an axis within its turn, in degrees: from 0 up to, but not including, `turn`, which must
// be above zero. Fails like from_pulses().
Result<Decimal> within_turn(std::int64_t pulses, const Decimal& turn, const Scale& scale);

}  // namespace axisgate
