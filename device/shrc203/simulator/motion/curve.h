// One coordinate of a stage that goes round a circle: where it is, where it turns, and when it gets somewhere.
#pragma once

#include <cstdint>
#include <optional>

#include "device/shrc203/simulator/mileage.h"

namespace axisgate::shrc203::simulator {

// radius * cos(phase + sweep * fraction), seen from where it began; the fraction of the path runs from 0 to 1.
struct Curve {
  double radius = 0;     // pulses
  double phase = 0;      // radians
  double sweep = 0;      // radians, not 0; its sign is the sense
  std::int64_t end = 0;  // exactly, whatever the arithmetic of the circle leaves over

  std::int64_t offset(double fraction) const;  // whole pulses, rounded
  // Adds the way from the beginning up to there, back and forth.
  void cover(double fraction, Mileage& mileage) const;
  // The first fraction at which it stands `level` away from its beginning; none when it never does. Not for 0.
  std::optional<double> reaches(double level) const;
  // The first fraction from `from` on at which it goes that way, +1 or -1.
  std::optional<double> heads(int direction, double from) const;

 private:
  double turning_after(double fraction) const;  // may be beyond 1
};

}  // namespace axisgate::shrc203::simulator
