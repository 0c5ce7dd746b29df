// Results of motions and of stops.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "axisgate/errors.h"
#include "axisgate/export.h"

namespace axisgate {

// A Position is the position of one axis.
struct AXISGATE_PUBLIC Position {
  std::string axis;                    // name of the axis, or its number as text
  std::string value;                   // in `unit`, as an exact decimal: "-0.25"; empty if unknown
  std::string unit;                    // "mm"
  std::optional<std::int64_t> pulses;  // in drive pulses; nullopt if unknown

  // Returns the value as a floating-point number; nullopt if unknown.
  std::optional<double> number() const;
  std::string text() const;  // "x 1.5 mm"
};

// A ScanResult has the numbers of trigger pulses of a scan. nullopt means unknown.
struct ScanResult {
  std::optional<std::int64_t> expected;           // due in the whole run
  std::optional<std::int64_t> expected_in_range;  // due within the range
  std::optional<std::int64_t> observed;           // in the whole run, computed from the displacement
};

// A MotionResult is the result of a motion that succeeded.
struct AXISGATE_PUBLIC MotionResult {
  std::string motion;                    // name of the motion; empty if none was necessary
  std::vector<Position> positions;       // final positions, in the order of the axes' numbers
  std::chrono::nanoseconds duration{0};  // from the start to the outcome
  std::optional<ScanResult> scan;        // nullopt: the motion was no scan

  // Returns the final position of an axis by its name. Throws InvalidArgument if the motion does not have the axis.
  const Position& position(std::string_view axis) const;
  std::string text() const;  // "x 1.5 mm, y -0.25 mm"
};

// An AxisStop is the result of a stop for one axis.
struct AXISGATE_PUBLIC AxisStop {
  Position position;               // as seen after the stop
  std::optional<bool> stationary;  // nullopt: the axis was not seen after the stop

  std::string text() const;  // "x 1.5 mm (stationary)"
};

// A StopReport is what was seen of a stop.
struct AXISGATE_PUBLIC StopReport {
  std::vector<AxisStop> axes;  // in the order of the axes' numbers
  // True if the axes were not confirmed stationary. The daemon then repeats the stop, and refuses motion of these axes.
  bool stays_open = false;
  std::optional<Error> problem;  // nullopt: no problem

  std::string text() const;
};

// A Progress is how far a motion has come.
struct Progress {
  std::optional<double> fraction;   // part of the distance that is covered, from 0 to 1; nullopt if unknown
  std::vector<Position> positions;  // present positions of the axes of the motion
  int segment = 0;                  // number of finished segments of a path
};

AXISGATE_PUBLIC std::ostream& operator<<(std::ostream& stream, const Position& position);
AXISGATE_PUBLIC std::ostream& operator<<(std::ostream& stream, const MotionResult& result);
AXISGATE_PUBLIC std::ostream& operator<<(std::ostream& stream, const AxisStop& stop);
AXISGATE_PUBLIC std::ostream& operator<<(std::ostream& stream, const StopReport& report);

}  // namespace axisgate
