#include "device/rml1/language/number_reader.h"

#include <cmath>

namespace axisgate::rml1 {

void NumberReader::begin(char c) {
  *this = {};
  if (c == '-' || c == '+') {
    negative_ = c == '-';
  } else {
    (void)take(c);
  }
}

double NumberReader::value() const {
  static constexpr double kPowers[] = {1,    1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                       1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};
  double value = static_cast<double>(mantissa_);
  if (decimals_ > 0) value /= kPowers[decimals_];
  if (tens_ > 0) value *= std::pow(10, tens_);
  return negative_ ? -value : value;
}

}  // namespace axisgate::rml1
