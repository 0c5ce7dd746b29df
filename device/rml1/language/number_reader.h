// Reads one parameter byte by byte (guideline 2-3, 2-5).
#pragma once

#include <cstdint>

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {

// A number is an optional sign, digits, an optional point, and digits. Any other byte ends it.
class NumberReader {
 public:
  // `c` begins a number.
  void begin(char c);
  // Returns false if the number has ended before `c`.
  bool take(char c) {
    if (is_digit(c)) {
      digit(c);
      return true;
    }
    if (c != '.' || point_) return false;
    point_ = true;
    return true;
  }

  bool sign_alone() const { return !digits_ && !point_; }  // no parameter
  bool point_alone() const { return !digits_ && point_; }  // 0, and the list ends ("PA . 100" is "PA0;100")
  bool has_point() const { return point_; }
  double value() const;

 private:
  void digit(char c) {
    digits_ = true;
    if (mantissa_ < kFull && decimals_ < kDecimals) {
      mantissa_ = mantissa_ * 10 + static_cast<std::uint64_t>(c - '0');
      if (point_) ++decimals_;
    } else if (!point_ && tens_ < kTens) {
      ++tens_;
    }
  }

  // Limit below which the mantissa takes one more digit. Digits that do not fit are far below anything that a step
  // could show.
  static constexpr std::uint64_t kFull = 100'000'000'000'000'000;
  static constexpr int kDecimals = 18;
  // Limit for further digits before the point: far beyond any range, but not beyond a double.
  static constexpr int kTens = 200;

  std::uint64_t mantissa_ = 0;
  int decimals_ = 0, tens_ = 0;
  bool negative_ = false, digits_ = false, point_ = false;
};

}  // namespace axisgate::rml1
