#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "device/core/escape.h"
#include "device/core/quantity.h"

namespace axisgate {
namespace {

constexpr int kDigitsMax = 18;

bool is_digit(char byte) { return byte >= '0' && byte <= '9'; }

// Digits before and after the point of an unsigned number.
struct Parts {
  std::string_view whole, fraction;
};

bool all_digits(std::string_view text) {
  for (const char byte : text) {
    if (!is_digit(byte)) return false;
  }
  return true;
}

// Splits a number. "5." is not a number: its last digits may have been lost on the line.
std::optional<Parts> split(std::string_view unsigned_text) {
  const std::size_t point = unsigned_text.find('.');
  Parts parts{unsigned_text.substr(0, point), {}};
  if (point == std::string_view::npos) {
    if (parts.whole.empty()) return std::nullopt;
  } else {
    parts.fraction = unsigned_text.substr(point + 1);
    if (parts.fraction.empty()) return std::nullopt;
  }
  if (!all_digits(parts.whole) || !all_digits(parts.fraction)) return std::nullopt;
  return parts;
}

// Reads what follows the "e": an optional sign, and one to three digits.
std::optional<int> exponent_of(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text.size() > 3 || !all_digits(text)) return std::nullopt;
  int exponent = 0;
  std::from_chars(text.data(), text.data() + text.size(), exponent);
  return negative ? -exponent : exponent;
}

}  // namespace

Result<Decimal> parse_decimal(std::string_view text) {
  const bool has_sign = !text.empty() && (text.front() == '+' || text.front() == '-');
  const std::size_t mark = std::min(text.find_first_of("eE"), text.size());
  const std::optional<Parts> parts = split(text.substr(0, mark).substr(has_sign ? 1 : 0));
  const std::optional<int> exponent = mark == text.size() ? 0 : exponent_of(text.substr(mark + 1));
  if (!parts || !exponent) {
    return fail(Reason::invalid_request, '"' + escaped(text) + "\" is not a number",
                "Write a number like 5, -200, 0.25 or 2.5e-3, without blanks.");
  }
  std::string digits = std::string(parts->whole).append(parts->fraction);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  int decimals = static_cast<int>(parts->fraction.size()) - *exponent;
  for (; decimals > 0 && digits.ends_with('0'); --decimals) digits.pop_back();
  if (digits.empty()) return Decimal{};
  if (decimals < 0 && decimals >= -kDigitsMax) digits.append(static_cast<std::size_t>(-decimals), '0');
  if (digits.size() > kDigitsMax || decimals < -kDigitsMax || decimals > kDigitsMax) {
    return fail(Reason::out_of_range, '"' + escaped(text) + "\" has more than 18 digits",
                "Use a larger unit or fewer decimals.");
  }
  Decimal value{0, std::max(decimals, 0)};
  for (const char digit : digits) value.digits = value.digits * 10 + (digit - '0');
  if (text.front() == '-') value.digits = -value.digits;
  return value;
}

Result<Decimal> decimal_of(double value, bool approximate) {
  if (!std::isfinite(value)) return fail(Reason::invalid_request, fmt::format("{} is not an amount", value));
  const Result<Decimal> shortest = parse_decimal(fmt::format("{}", value));
  if (shortest || !approximate || std::abs(value) > 1) return shortest;
  return parse_decimal(fmt::format("{:.15f}", value));
}

std::string to_string(Decimal value) {
  assert(value.decimals >= 0);
  std::string text = std::to_string(value.digits);
  const bool negative = text.front() == '-';
  if (negative) text.erase(0, 1);
  const auto decimals = static_cast<std::size_t>(value.decimals);
  if (text.size() <= decimals) text.insert(0, decimals + 1 - text.size(), '0');
  if (decimals > 0) text.insert(text.size() - decimals, 1, '.');
  return negative ? '-' + text : text;
}

}  // namespace axisgate
