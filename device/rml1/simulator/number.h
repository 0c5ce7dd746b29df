// One number of a parameter list (guideline 2-3 [Parameter], 2-5).
#pragma once

namespace axisgate::rml1::simulator {

bool may_begin_number(char byte);  // 0-9 + - .

class Number {
 public:
  // Takes a byte if it belongs to this number. Returns false if the number has ended before it.
  bool take(char byte);

  bool empty() const { return !signed_ && !has_point_ && !has_digit_; }
  bool is_sign_alone() const { return signed_ && !has_point_ && !has_digit_; }
  bool is_point_alone() const { return has_point_ && !has_digit_; }
  bool has_point() const { return has_point_; }
  double value() const;

 private:
  bool signed_ = false, negative_ = false, has_point_ = false, has_digit_ = false;
  double digits_ = 0;   // all digits as a whole number
  double divisor_ = 1;  // 10 to the power of the number of digits after the point
};

}  // namespace axisgate::rml1::simulator
