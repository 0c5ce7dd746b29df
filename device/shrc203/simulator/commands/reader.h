// Reads a command line from the left, in the forms that the manual shows and in the loose ones that clients send. The
// text is in upper case and has no blanks.
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

// Sign, unit letter, number: "+P1000". Without a sign it is positive, without a unit pulses.
struct Amount {
  Number number;
  char unit = 'P';
};

// Each take_ leaves the text untouched when it finds nothing of its kind.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool done() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }
  bool take(char letter);
  bool take_text(std::string_view text);

  std::optional<Axes> take_axes(const Axes& controllable);
  // All controllable axes when nothing is left.
  std::optional<Axes> take_axes_or_all(const Axes& controllable);
  std::optional<int> take_digit(int highest);
  int take_sign();  // +1 or -1; +1 when there is none
  std::optional<Number> take_number();
  std::optional<std::int64_t> take_integer(std::int64_t lowest, std::int64_t highest);  // "100.0" is one, too
  std::optional<Amount> take_amount(std::string_view units);

 private:
  std::string_view rest_;
};

}  // namespace axisgate::shrc203::simulator
