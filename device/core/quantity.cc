#include "device/core/quantity.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "device/core/escape.h"

namespace axisgate {
namespace {

// Wide enough for 18 digits of a value times the powers of ten of units and decimals, which do not fit into 64 bits.
__extension__ typedef __int128 Wide;

struct Spelling {
  std::string_view text;
  Unit unit;
};

constexpr Spelling kSpellings[] = {
    {"pulse", Unit::pulses},        {"pulses", Unit::pulses},       {"p", Unit::pulses},
    {"pls", Unit::pulses},          {"nm", Unit::nanometers},       {"um", Unit::micrometers},
    {"\u00b5m", Unit::micrometers}, {"\u03bcm", Unit::micrometers}, {"mm", Unit::millimeters},
    {"deg", Unit::degrees},         {"degree", Unit::degrees},      {"degrees", Unit::degrees},
    {"\u00b0", Unit::degrees},
};

std::string in_quotes(std::string_view text) { return '"' + escaped(text) + '"'; }

std::string text_of(Decimal value, Unit unit) { return to_string(value).append(symbol(unit)); }

// Returns the power of ten between a unit and the unit of Scale::per_pulse: nanometres, or millionths of a degree.
int scale_units_exponent(Unit unit) {
  switch (unit) {
    case Unit::pulses:
    case Unit::nanometers:
      return 0;
    case Unit::micrometers:
      return 3;
    case Unit::millimeters:
    case Unit::degrees:
      return 6;
  }
  return 0;
}

std::optional<Wide> times_power_of_ten(Wide value, int exponent) {
  for (; exponent > 0; --exponent) {
    if (__builtin_mul_overflow(value, 10, &value)) return std::nullopt;
  }
  return value;
}

// Returns nullopt if the number has more than 18 digits.
std::optional<Decimal> to_decimal(Wide digits, int decimals) {
  for (; decimals > 0 && digits % 10 == 0; --decimals) digits /= 10;
  constexpr Wide kEnd = 1'000'000'000'000'000'000;
  if (digits <= -kEnd || digits >= kEnd || decimals > 18) return std::nullopt;
  return Decimal{static_cast<std::int64_t>(digits), decimals};
}

tl::unexpected<Problem> too_many_digits(std::int64_t pulses, Unit unit, const Scale& scale) {
  return fail(Reason::out_of_range,
              std::to_string(pulses) + " pulses of " + to_string(scale.per_pulse) + " have more than 18 digits in " +
                  std::string(symbol(unit)),
              "Ask for the position in pulses.");
}

Result<void> check_unit(Unit unit, const Scale& scale) {
  if (unit == Unit::pulses) return {};
  if (unit == Unit::degrees && !scale.rotary) {
    return fail(Reason::unknown_unit, "an angle (deg) was given for an axis that moves in a straight line",
                "Use nm, um, mm or pulse on this axis.");
  }
  if (unit != Unit::degrees && scale.rotary) {
    return fail(Reason::unknown_unit, "a length (" + std::string(symbol(unit)) + ") was given for an axis that turns",
                "Use deg or pulse on this axis.");
  }
  if (scale.per_pulse.digits <= 0) {
    return fail(Reason::device_error,
                "the axis has no usable scale: one pulse is " + to_string(scale.per_pulse) + " nm",
                "Check the controller's memory switches BASE RATE and DIVIDE; positions in pulses still work.");
  }
  return {};
}

std::string range_hint(Unit unit, const Scale& scale) {
  const Result<Decimal> limit = from_pulses(kPulsesMax, unit, scale);
  if (unit == Unit::pulses || !limit) return "Ask for less.";
  return "At " + pulse_text(scale) + " a pulse that is " + text_of(*limit, unit) + " either way.";
}

tl::unexpected<Problem> out_of_range(const Quantity& quantity, const Scale& scale) {
  return fail(
      Reason::out_of_range,
      in_quotes(text_of(quantity.value, quantity.unit)) + " is beyond the 999,999,999 pulses that a command can carry",
      range_hint(quantity.unit, scale));
}

// `per` is "" or "/s". For a speed below 1 pulse/s the message names only 1 pulse/s, because 0 is not a speed.
tl::unexpected<Problem> not_representable(const Quantity& quantity, const Scale& scale, std::int64_t below,
                                          std::string_view per) {
  const auto nearest = [&](std::int64_t count) {
    const Result<Decimal> way = from_pulses(count, quantity.unit, scale);
    return (way ? text_of(*way, quantity.unit) : text_of(Decimal{count, 0}, Unit::pulses)).append(per);
  };
  const std::string size = quantity.unit == Unit::pulses ? "" : " of " + pulse_text(scale);
  const bool lowest = !per.empty() && below == 0;
  return fail(Reason::not_representable,
              in_quotes(text_of(quantity.value, quantity.unit).append(per)) + " is not a whole number of pulses" +
                  size + (per.empty() ? "" : " a second") +
                  (lowest ? "; the nearest is " : "; the nearest are " + nearest(below) + " and ") + nearest(below + 1),
              lowest ? "Ask for this." : "Ask for one of these.");
}

// Returns the length of the number at the beginning of `text`, with its exponent: 4 for "1e-3mm".
std::size_t end_of_number(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t end = std::min(text.find_first_not_of("+-.0123456789"), text.size());
  if (end == text.size() || (text[end] != 'e' && text[end] != 'E')) return end;
  std::size_t exponent = end + 1;
  if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
  const std::size_t after = std::min(text.find_first_not_of(kDigits, exponent), text.size());
  return after == exponent ? end : after;
}

Result<std::int64_t> whole_pulses(const Quantity& quantity, const Scale& scale, std::string_view per) {
  if (auto fits = check_unit(quantity.unit, scale); !fits) return tl::make_unexpected(fits.error());
  const Decimal per_pulse = quantity.unit == Unit::pulses ? Decimal{1, 0} : scale.per_pulse;
  const int exponent = scale_units_exponent(quantity.unit) + per_pulse.decimals - quantity.value.decimals;
  const std::optional<Wide> numerator = times_power_of_ten(quantity.value.digits, exponent);
  const std::optional<Wide> denominator = times_power_of_ten(per_pulse.digits, -exponent);
  // An overflowing numerator is beyond 10^38 / 10^18 pulses; a denominator cannot overflow within Decimal's limits.
  if (!numerator || !denominator) return out_of_range(quantity, scale);
  const Wide remainder = *numerator % *denominator;
  const Wide below = *numerator / *denominator - (remainder < 0 ? 1 : 0);
  const Wide above = below + (remainder != 0 ? 1 : 0);
  const Wide twice_beyond = 2 * (*numerator - below * *denominator);
  const bool up = twice_beyond > *denominator || (twice_beyond == *denominator && below >= 0);
  const Wide nearest = up ? above : below;
  const auto [least, most] = quantity.nearest ? std::pair(nearest, nearest) : std::pair(below, above);
  if (least < -kPulsesMax || most > kPulsesMax) return out_of_range(quantity, scale);
  if (least != most) return not_representable(quantity, scale, static_cast<std::int64_t>(below), per);
  return static_cast<std::int64_t>(least);
}

}  // namespace

std::string_view symbol(Unit unit) {
  switch (unit) {
    case Unit::pulses:
      return "pulse";
    case Unit::nanometers:
      return "nm";
    case Unit::micrometers:
      return "um";
    case Unit::millimeters:
      return "mm";
    case Unit::degrees:
      return "deg";
  }
  return "pulse";
}

Result<Unit> parse_unit(std::string_view text) {
  for (const Spelling& spelling : kSpellings) {
    if (text == spelling.text) return spelling.unit;
  }
  return fail(Reason::unknown_unit, in_quotes(text) + " is not a unit", "Use pulse, nm, um, mm or deg.");
}

Result<Quantity> parse_quantity(std::string_view text, Unit fallback) {
  if (text.ends_with("/s")) {
    return fail(Reason::invalid_request, in_quotes(text) + " is a speed where a distance or position is wanted",
                "Leave out the \"/s\".");
  }
  const std::size_t end = end_of_number(text);
  if (end < text.size() && text[end] == ',') {
    return fail(Reason::invalid_request, in_quotes(text) + " has a comma where a decimal point is needed",
                "Write a decimal point, and nothing between thousands, e.g. 12.5um or 1000um.");
  }
  const Result<Decimal> value = parse_decimal(text.substr(0, end));
  if (!value) {
    Problem problem = value.error();
    if (problem.reason == Reason::invalid_request) problem.message = in_quotes(text) + " is not a number with a unit";
    return tl::make_unexpected(problem);
  }
  if (end == text.size()) return Quantity{*value, fallback};
  return parse_unit(text.substr(end)).map([&](Unit unit) { return Quantity{*value, unit}; });
}

Result<Quantity> parse_speed(std::string_view text, Unit fallback) {
  if (text.ends_with("/s")) text.remove_suffix(2);
  return parse_quantity(text, fallback);
}

Result<std::int64_t> to_pulses(const Quantity& quantity, const Scale& scale) {
  return whole_pulses(quantity, scale, "");
}

Result<std::int64_t> to_pulses_per_second(const Quantity& speed, const Scale& scale) {
  return whole_pulses(speed, scale, "/s");
}

Result<Decimal> from_pulses(std::int64_t pulses, Unit unit, const Scale& scale) {
  if (auto fits = check_unit(unit, scale); !fits) return tl::make_unexpected(fits.error());
  const Decimal per_pulse = unit == Unit::pulses ? Decimal{1, 0} : scale.per_pulse;
  const auto way = to_decimal(Wide{pulses} * per_pulse.digits, per_pulse.decimals + scale_units_exponent(unit));
  if (!way) return too_many_digits(pulses, unit, scale);
  return *way;
}

Result<Decimal> within_turn(std::int64_t pulses, const Decimal& turn, const Scale& scale) {
  if (auto fits = check_unit(Unit::degrees, scale); !fits) return tl::make_unexpected(fits.error());
  const int decimals = scale.per_pulse.decimals + scale_units_exponent(Unit::degrees);
  const int common = std::max(decimals, turn.decimals);
  const auto way = times_power_of_ten(Wide{pulses} * scale.per_pulse.digits, common - decimals);
  const auto whole = times_power_of_ten(turn.digits, common - turn.decimals);
  if (!way || !whole) return too_many_digits(pulses, Unit::degrees, scale);
  const Wide rest = *way % *whole;
  const auto place = to_decimal(rest < 0 ? rest + *whole : rest, common);
  if (!place) return too_many_digits(pulses, Unit::degrees, scale);
  return *place;
}

std::string pulse_text(const Scale& scale) {
  return scale.rotary ? to_string(from_pulses(1, Unit::degrees, scale).value_or(Decimal{})) + " deg"
                      : to_string(scale.per_pulse) + " nm";
}

Result<Scale> scale_of(const Quantity& pulse) {
  if (pulse.unit == Unit::pulses || pulse.value.digits <= 0) {
    return fail(Reason::invalid_request,
                in_quotes(text_of(pulse.value, pulse.unit)) + " is no resolution (displacement of one pulse)",
                "Give a displacement above 0 in nm, um, mm or deg.");
  }
  const int decimals = pulse.value.decimals - scale_units_exponent(pulse.unit);
  const auto digits = times_power_of_ten(pulse.value.digits, -decimals);
  const auto per_pulse = digits ? to_decimal(*digits, std::max(decimals, 0)) : std::nullopt;
  if (!per_pulse) {
    return fail(Reason::out_of_range,
                in_quotes(text_of(pulse.value, pulse.unit)) + " has more than 18 digits as a pulse",
                "Give a shorter displacement.");
  }
  return Scale{*per_pulse, pulse.unit == Unit::degrees};
}

}  // namespace axisgate
