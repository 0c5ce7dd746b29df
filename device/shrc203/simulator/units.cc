#include "device/shrc203/simulator/units.h"

#include <fmt/format.h>

namespace axisgate::shrc203::simulator {
namespace {

__extension__ using Wide = __int128;

constexpr int kDecimalsShown = 9;

// Returns the size of the unit in millionths of a nanometre; 0 for pulses.
std::int64_t unit_size(char unit) {
  switch (unit) {
    case 'N':
      return 1'000'000;
    case 'U':
      return 1'000'000'000;
    case 'M':
    case 'D':
      return 1'000'000'000'000;
    default:
      return 0;
  }
}

std::int64_t power_of_ten(int exponent) {
  std::int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

// Converts a non-negative numerator over a positive denominator to decimals; the last decimal is rounded.
std::string decimal_text(Wide numerator, Wide denominator) {
  const Wide scaled = (numerator * power_of_ten(kDecimalsShown) * 2 + denominator) / (denominator * 2);
  const auto whole = static_cast<std::int64_t>(scaled / power_of_ten(kDecimalsShown));
  const auto rest = static_cast<std::int64_t>(scaled % power_of_ten(kDecimalsShown));
  if (rest == 0) return std::to_string(whole);
  std::string text = fmt::format("{}.{:0{}}", whole, rest, kDecimalsShown);
  text.erase(text.find_last_not_of('0') + 1);
  return text;
}

std::size_t decimals_in(std::string_view text) {
  const auto point = text.find('.');
  return point == std::string_view::npos ? 0 : text.size() - point - 1;
}

}  // namespace

bool is_unit(char letter) { return letter == 'P' || letter == 'F' || unit_size(letter) != 0; }

std::optional<std::int64_t> to_pulses(Number number, char unit, Pitch pitch, Fraction fraction) {
  Wide numerator = number.digits;
  Wide denominator = power_of_ten(number.decimals);
  if (const std::int64_t size = unit_size(unit); size != 0) {
    numerator *= static_cast<Wide>(size) * pitch.divide;
    denominator *= pitch.nanometers_e6;
  }
  const bool negative = numerator < 0;
  const Wide magnitude = negative ? -numerator : numerator;
  if (magnitude % denominator != 0 && fraction == Fraction::refuse) return std::nullopt;
  const Wide pulses =
      fraction == Fraction::truncate ? magnitude / denominator : (magnitude * 2 + denominator) / (denominator * 2);
  if (pulses > INT64_MAX / 4) return std::nullopt;
  return static_cast<std::int64_t>(negative ? -pulses : pulses);
}

std::string from_pulses(std::int64_t pulses, char unit, Pitch pitch) {
  const std::int64_t size = unit_size(unit);
  if (size == 0) return std::to_string(pulses);
  const Wide magnitude = static_cast<Wide>(pulses < 0 ? -pulses : pulses) * pitch.nanometers_e6;
  std::string text = decimal_text(magnitude, static_cast<Wide>(size) * pitch.divide);
  return pulses < 0 ? "-" + text : text;
}

std::string from_pulses_by_resolution(std::int64_t pulses, char unit, Pitch pitch) {
  std::string text = from_pulses(pulses, unit, pitch);
  const std::size_t wanted = decimals_in(from_pulses(1, unit, pitch));
  const std::size_t shown = decimals_in(text);
  if (wanted > 0 && shown == 0) text += '.';
  if (wanted > shown) text.append(wanted - shown, '0');
  return text;
}

std::string to_text(Number number) { return decimal_text(number.digits, power_of_ten(number.decimals)); }

}  // namespace axisgate::shrc203::simulator
