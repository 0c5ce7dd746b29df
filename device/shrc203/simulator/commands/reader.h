// Reads a command line from the left, in the manual's forms and in the looser ones that clients send. The text is in
// upper case and has no blanks.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/motion/motion_profile.h"
#include "device/shrc203/simulator/units.h"

namespace axisgate::shrc203::simulator {

// Farthest coordinate that a command can name, in pulses, in either direction.
inline constexpr std::int64_t kCoordinateMax = 999'999'999;

// Sign, unit letter, number: "+P1000". Positive without a sign; pulses without a unit.
struct Amount {
  Number number;
  char unit = 'P';
};

// Each take_ function leaves the text unchanged if it does not find its kind of value.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool done() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }
  bool take(char letter);
  bool take_text(std::string_view text);

  std::optional<Axes> take_axes(const Axes& controllable);
  // Returns all controllable axes if nothing is left.
  std::optional<Axes> take_axes_or_all(const Axes& controllable);
  std::optional<int> take_digit(int highest);
  int take_sign();  // +1 or -1; +1 if there is none
  std::optional<Number> take_number();
  std::optional<std::int64_t> take_integer(std::int64_t lowest, std::int64_t highest);  // accepts "100.0" too
  std::optional<Amount> take_amount(std::string_view units);

 private:
  std::string_view rest_;
};

}  // namespace axisgate::shrc203::simulator
