#include "device/rml1/simulator/number.h"

namespace axisgate::rml1::simulator {
namespace {

bool is_digit(char byte) { return byte >= '0' && byte <= '9'; }
bool is_sign(char byte) { return byte == '+' || byte == '-'; }

// Divisor from which further digits after the point are ignored: they change no step.
constexpr double kDivisorMax = 1e9;

}  // namespace

bool may_begin_number(char byte) { return is_digit(byte) || is_sign(byte) || byte == '.'; }

bool Number::take(char byte) {
  if (is_sign(byte)) {
    if (!empty()) return false;
    signed_ = true;
    negative_ = byte == '-';
    return true;
  }
  if (byte == '.') {
    if (has_point_) return false;
    has_point_ = true;
    return true;
  }
  if (!is_digit(byte)) return false;
  has_digit_ = true;
  if (has_point_ && divisor_ >= kDivisorMax) return true;
  digits_ = digits_ * 10 + (byte - '0');
  if (has_point_) divisor_ *= 10;
  return true;
}

double Number::value() const { return (negative_ ? -digits_ : digits_) / divisor_; }

}  // namespace axisgate::rml1::simulator
