#include <algorithm>
#include <cassert>
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

}  // namespace

Result<Decimal> parse_decimal(std::string_view text) {
  const bool has_sign = !text.empty() && (text.front() == '+' || text.front() == '-');
  const std::optional<Parts> parts = split(text.substr(has_sign ? 1 : 0));
  if (!parts) {
    return fail(Reason::invalid_request, '"' + escaped(text) + "\" is not a number",
                "Write a number like 5, -200 or 0.25: no exponent, no blanks.");
  }
  std::string_view fraction = parts->fraction;
  while (!fraction.empty() && fraction.back() == '0') fraction.remove_suffix(1);
  std::string digits = std::string(parts->whole).append(fraction);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  if (digits.size() > kDigitsMax || fraction.size() > kDigitsMax) {
    return fail(Reason::out_of_range, '"' + escaped(text) + "\" has more than 18 digits",
                "Use a larger unit or fewer decimals.");
  }
  Decimal value{0, static_cast<int>(fraction.size())};
  for (const char digit : digits) value.digits = value.digits * 10 + (digit - '0');
  if (text.front() == '-') value.digits = -value.digits;
  return value;
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
