#include "device/shrc203/simulator/commands/reader.h"

#include <cctype>

namespace axisgate::shrc203::simulator {
namespace {

constexpr int kDigitsMax = 15;
constexpr int kDecimalsMax = 9;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

bool Reader::take(char letter) {
  if (rest_.empty() || rest_.front() != letter) return false;
  rest_.remove_prefix(1);
  return true;
}

bool Reader::take_text(std::string_view text) {
  if (!rest_.starts_with(text)) return false;
  rest_.remove_prefix(text.size());
  return true;
}

std::optional<Axes> Reader::take_axes(const Axes& controllable) {
  if (rest_.empty()) return std::nullopt;
  const auto axes = axes_of_letter(rest_.front(), controllable);
  if (axes) rest_.remove_prefix(1);
  return axes;
}

std::optional<Axes> Reader::take_axes_or_all(const Axes& controllable) {
  return done() ? controllable : take_axes(controllable);
}

std::optional<int> Reader::take_digit(int highest) {
  if (rest_.empty() || !is_digit(rest_.front()) || rest_.front() - '0' > highest) return std::nullopt;
  const int digit = rest_.front() - '0';
  rest_.remove_prefix(1);
  return digit;
}

int Reader::take_sign() {
  if (take('-')) return -1;
  take('+');
  return 1;
}

std::optional<Number> Reader::take_number() {
  Number number;
  int digits = 0;
  bool point = false;
  std::size_t length = 0;
  for (; length < rest_.size(); ++length) {
    const char c = rest_[length];
    if (c == '.' && !point) {
      point = true;
    } else if (is_digit(c)) {
      if (++digits > kDigitsMax) return std::nullopt;
      number.digits = number.digits * 10 + (c - '0');
      number.decimals += point ? 1 : 0;
    } else {
      break;
    }
  }
  if (digits == 0 || number.decimals > kDecimalsMax) return std::nullopt;
  rest_.remove_prefix(length);
  return number;
}

std::optional<std::int64_t> Reader::take_integer(std::int64_t lowest, std::int64_t highest) {
  const std::string_view before = rest_;
  const auto number = take_number();
  const auto value = number ? to_pulses(*number, 'P', {1, 1}, Fraction::refuse) : std::nullopt;
  if (value && *value >= lowest && *value <= highest) return value;
  rest_ = before;
  return std::nullopt;
}

std::optional<Amount> Reader::take_amount(std::string_view units) {
  const std::string_view before = rest_;
  Amount amount;
  const int sign = take_sign();
  if (!rest_.empty() && std::isalpha(static_cast<unsigned char>(rest_.front())) != 0) {
    amount.unit = rest_.front();
    if (units.find(amount.unit) == std::string_view::npos) {
      rest_ = before;
      return std::nullopt;
    }
    rest_.remove_prefix(1);
  }
  const auto number = take_number();
  if (!number) {
    rest_ = before;
    return std::nullopt;
  }
  amount.number = {sign * number->digits, number->decimals};
  return amount;
}

}  // namespace axisgate::shrc203::simulator
