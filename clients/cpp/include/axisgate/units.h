// Amounts with units: mm("1.5"), um(200), 1.5_mm, mm(2).per_second().
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "axisgate/export.h"

namespace axisgate {

class Speed;

// A Distance is a position or a displacement. Text and whole numbers are exact: the daemon refuses an amount that is
// not a whole number of pulses. A floating-point number becomes the nearest whole number of pulses, and the result of
// the motion says which. A bare number is no Distance.
class AXISGATE_PUBLIC Distance {
 public:
  // Number: an exact decimal, or a floating-point number.
  using Number = std::variant<std::string, double>;

  // `unit` is "pulses", "nm", "um", "mm" or "deg". Throws InvalidArgument if the text is not a decimal number, or the
  // floating-point number is not finite.
  Distance(Number number, std::string_view unit);

  const Number& number() const noexcept { return number_; }
  const std::string& unit() const noexcept { return unit_; }
  bool is_negative() const noexcept;
  // Returns the speed of this distance in each second.
  Speed per_second() const;
  Distance operator-() const;
  std::string text() const;  // "1.5 mm"

 private:
  Number number_;
  std::string unit_;
};

// A Speed is a Distance for each second. A jog in the minus direction has a negative speed.
class AXISGATE_PUBLIC Speed {
 public:
  explicit Speed(Distance each_second) : each_second_(std::move(each_second)) {}

  const Distance& each_second() const noexcept { return each_second_; }
  Speed operator-() const { return Speed(-each_second_); }
  std::string text() const { return each_second_.text() + "/s"; }

 private:
  Distance each_second_;
};

inline Speed Distance::per_second() const { return Speed(*this); }

// Numbers of amounts.
template <class T>
concept Numeric = std::integral<T> || std::floating_point<T>;

namespace detail {
template <Numeric T>
Distance::Number to_number(T number) {
  if constexpr (std::floating_point<T>) {
    return static_cast<double>(number);
  } else {
    return std::to_string(number);
  }
}
inline Distance::Number to_number(std::string_view text) { return std::string(text); }
}  // namespace detail

// Returns a distance in drive pulses, the smallest step of an axis.
Distance pulses(const auto& number) { return {detail::to_number(number), "pulses"}; }
// Returns a distance in nanometres.
Distance nm(const auto& number) { return {detail::to_number(number), "nm"}; }
// Returns a distance in micrometres.
Distance um(const auto& number) { return {detail::to_number(number), "um"}; }
// Returns a distance in millimetres.
Distance mm(const auto& number) { return {detail::to_number(number), "mm"}; }
// Returns a distance in degrees, for a rotary axis.
Distance deg(const auto& number) { return {detail::to_number(number), "deg"}; }

// Exact amounts: 1.5_mm is mm("1.5").
namespace literals {
inline Distance operator""_nm(const char* digits) { return nm(std::string_view(digits)); }
inline Distance operator""_um(const char* digits) { return um(std::string_view(digits)); }
inline Distance operator""_mm(const char* digits) { return mm(std::string_view(digits)); }
inline Distance operator""_deg(const char* digits) { return deg(std::string_view(digits)); }
inline Distance operator""_pulses(const char* digits) { return pulses(std::string_view(digits)); }
}  // namespace literals

}  // namespace axisgate
