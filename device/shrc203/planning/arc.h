// The curves of E: and EP: (manual 71) to 82)): their ends, extents and lengths. The whole curve is checked against the
// travel limits before its line is sent.
#pragma once

#include <cstdint>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// A point in the plane of two axes, the axis with the smaller number first (manual 71), c1 and c2). Whole pulses from
// the start of the curve, as to_pulses() returns them: at most +-kPulsesMax.
struct PlanePoint {
  std::int64_t first = 0;
  std::int64_t second = 0;

  friend bool operator==(const PlanePoint&, const PlanePoint&) = default;
};

// A piece of a circle, or several turns of it. Described by its start and sweep and not by its center: with three
// points nearly on one line, the center is too far off to compute with.
struct Arc {
  double radius = 0;   // pulses
  double heading = 0;  // radians: direction at the start, 0 along the first axis, a quarter turn along the second
  double sweep = 0;    // radians: total turn, above 0 counterclockwise; not 0
  double rise = 0;     // pulses of the third axis over the whole curve, at a constant rate; 0 for a flat curve
};

// E:0. A center at the present position gives a length of 0.
Arc whole_circle(PlanePoint center, Rotation rotation);
// E:1, above 0 and up to 360 degrees. Fails with out_of_range.
Result<Arc> arc_by_angle(PlanePoint center, double degrees, Rotation rotation);
// E:2. The passing point decides the direction, whatever d is: see other_way(). Fails with invalid_request if the three
// points lie on one line or two of them are the same; with out_of_range if the curve leaves the counter's range.
Result<Arc> arc_through(PlanePoint passing, PlanePoint end);

// E:3, 1 to 1000 turns. The rise is per turn. Fails with out_of_range.
Result<Arc> helix_of_turns(PlanePoint center, int turns, Rotation rotation, std::int64_t rise_of_turn);
// E:4, above 0 and up to 360000 degrees. The rise is per turn for one turn or more, and the total rise for less than
// one turn. Fails with out_of_range.
Result<Arc> helix_by_angle(PlanePoint center, double degrees, Rotation rotation, std::int64_t rise);
// E:5. Rise: in total. Otherwise as arc_through().
Result<Arc> helix_through(PlanePoint passing, PlanePoint end, std::int64_t rise);

// Returns the d that matches the curve's direction.
Rotation rotation_of(const Arc& arc);

// Returns the curve from the same start to the same end along the rest of the circle: the meaning of E:2 or E:5 if d
// decided and not the passing point. `arc` must be less than one turn. Fails with out_of_range as arc_through() does.
Result<Arc> other_way(const Arc& arc);

// Displacements in pulses from the start, rounded to the nearest pulse. The end that the controller computes for E:1,
// E:4 and their EP: may differ (manual 72), 75): "an error occurs").
struct ArcEnd {
  std::int64_t first = 0;
  std::int64_t second = 0;
  std::int64_t third = 0;

  friend bool operator==(const ArcEnd&, const ArcEnd&) = default;
};
ArcEnd end_of(const Arc& arc);

// Reports whether the curve ends exactly on whole pulses, within the precision of the computation.
bool ends_on_whole_pulses(const Arc& arc);

// A range in whole pulses from the start, both ends inclusive, rounded outwards: the controller's rounding is not
// known.
struct Extent {
  std::int64_t lowest = 0;
  std::int64_t highest = 0;

  friend bool operator==(const Extent&, const Extent&) = default;
};

struct ArcExtent {
  Extent first, second, third;

  friend bool operator==(const ArcExtent&, const ArcExtent&) = default;
};
// Returns the range that each axis covers: the start, the end, and each point between where the axis turns back.
ArcExtent extent_of(const Arc& arc);

// Returns the length in pulses, of circle and rise together.
double length_of(const Arc& arc);

// Returns the duration at speed S of the lowest axis, in pulses/s and at least 1; the curve runs at this speed
// throughout (manual 71) to 82), "composite speed"). Durations above about thirty years are cut to that.
Duration duration_of(const Arc& arc, std::int64_t path_speed);

}  // namespace axisgate::shrc203
