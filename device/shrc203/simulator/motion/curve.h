// One coordinate of a stage that moves along a circle: its position, its turning points, and when it reaches a level.
#pragma once

#include <cstdint>
#include <optional>

#include "device/shrc203/simulator/mileage.h"

namespace axisgate::shrc203::simulator {

// The coordinate is radius * cos(phase + sweep * fraction), relative to its start; fraction is the covered part of the
// path, 0 to 1.
struct Curve {
  double radius = 0;     // pulses
  double phase = 0;      // radians
  double sweep = 0;      // radians, not 0; the sign is the direction
  std::int64_t end = 0;  // exact end, without the rounding errors of the circle

  std::int64_t offset(double fraction) const;  // whole pulses, rounded
  // Adds the distance from the start to this fraction, back and forth.
  void cover(double fraction, Mileage& mileage) const;
  // Returns the first fraction at which the coordinate is `level` away from its start; nullopt if it never is. Must not
  // be called for 0.
  std::optional<double> reaches(double level) const;
  // Returns the first fraction from `from` on at which the coordinate moves in this direction, +1 or -1; nullopt if it
  // never does.
  std::optional<double> heads(int direction, double from) const;

 private:
  double turning_after(double fraction) const;  // may be above 1
};

}  // namespace axisgate::shrc203::simulator
