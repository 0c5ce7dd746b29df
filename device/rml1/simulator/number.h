// One number of a parameter list (guideline 2-3 [Parameter], 2-5).
#pragma once

namespace axisgate::rml1::simulator {

bool may_begin_number(char byte);  // 0-9 + - .

class Number {
 public:
  // Whether `byte` belongs to this number; if not, the number has ended before it.
  bool take(char byte);

  bool empty() const { return !signed_ && !has_point_ && !has_digit_; }
  bool is_sign_alone() const { return signed_ && !has_point_ && !has_digit_; }
  bool is_point_alone() const { return has_point_ && !has_digit_; }
  bool has_point() const { return has_point_; }
  double value() const;

 private:
  bool signed_ = false, negative_ = false, has_point_ = false, has_digit_ = false;
  double digits_ = 0;   // all of them as a whole number
  double divisor_ = 1;  // 10 for each digit after the point
};

}  // namespace axisgate::rml1::simulator
