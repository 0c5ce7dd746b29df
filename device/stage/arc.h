// The curves of E: and EP: (manual 71) to 82)): where one ends, how far out it leads, how long it is. The whole of it
// is checked against the travel limits before its line is sent.
#pragma once

#include <cstdint>

#include "device/core/problem.h"
#include "device/core/time.h"

namespace axisgate::stage {

// In the plane of two axes, the one with the smaller number first (manual 71), c1 and c2): whole pulses from where they
// stand when the curve begins, as to_pulses() gives them: +-kPulsesMax at most.
struct PlanePoint {
  std::int64_t first = 0;
  std::int64_t second = 0;

  friend bool operator==(const PlanePoint&, const PlanePoint&) = default;
};

// The command's d, 0 and 1, where the first axis points to the right and the second one up.
enum class Rotation { clockwise, counterclockwise };

// A piece of a circle, or several turns of it. Described by its course and not by its center, which is too far off to
// compute with where three points lie nearly on one line.
struct Arc {
  double radius = 0;   // pulses
  double heading = 0;  // radians: the direction of its start, 0 along the first axis, a quarter turn along the second
  double sweep = 0;    // radians by which it turns, above 0 counterclockwise; not 0
  double rise = 0;     // pulses that the third axis goes meanwhile, evenly; 0 where the curve lies in the plane
};

// E:0. With its center where the axes stand it has no length.
Arc whole_circle(PlanePoint center, Rotation rotation);
// E:1, above 0 and up to 360 degrees. out_of_range.
Result<Arc> arc_by_angle(PlanePoint center, double degrees, Rotation rotation);
// E:2. The passing point says which way around, whatever d does: see other_way(). invalid_request for three points on
// one line, also where two are the same; out_of_range where it would leave what the controller counts.
Result<Arc> arc_through(PlanePoint passing, PlanePoint end);

// E:3, 1 to 1000 turns. The rise is that of one turn. out_of_range.
Result<Arc> helix_of_turns(PlanePoint center, int turns, Rotation rotation, std::int64_t rise_of_turn);
// E:4, above 0 and up to 360000 degrees. The rise is that of one turn from a whole one on, below it is that of all.
// out_of_range.
Result<Arc> helix_by_angle(PlanePoint center, double degrees, Rotation rotation, std::int64_t rise);
// E:5. Otherwise as arc_through().
Result<Arc> helix_through(PlanePoint passing, PlanePoint end, std::int64_t rise);

// The d that goes with it.
Rotation rotation_of(const Arc& arc);

// From the same start to the same end by the rest of the circle: what E:2 or E:5 would be if its d counted and not its
// passing point. Of less than one turn. out_of_range as arc_through().
Result<Arc> other_way(const Arc& arc);

// Pulses from the start, the nearest whole ones. The end that the controller computes for E:1, E:4 and their EP: may
// differ (manual 72), 75): "an error occurs").
struct ArcEnd {
  std::int64_t first = 0;
  std::int64_t second = 0;
  std::int64_t third = 0;

  friend bool operator==(const ArcEnd&, const ArcEnd&) = default;
};
ArcEnd end_of(const Arc& arc);

// Whether the curve ends on them exactly, as far as can be computed.
bool ends_on_whole_pulses(const Arc& arc);

// Whole pulses from the start, both inclusive, rounded outwards: the controller's rounding is not known.
struct Extent {
  std::int64_t lowest = 0;
  std::int64_t highest = 0;

  friend bool operator==(const Extent&, const Extent&) = default;
};

struct ArcExtent {
  Extent first, second, third;

  friend bool operator==(const ArcExtent&, const ArcExtent&) = default;
};
// Start and end, and wherever an axis turns back in between.
ArcExtent extent_of(const Arc& arc);

// Of circle and rise together, in pulses.
double length_of(const Arc& arc);

// At the speed S of the lower axis in pulses/s, 1 or more, which is that of the curve throughout (manual 71) to 82),
// "composite speed"). Thirty years stand for anything longer.
Duration duration_of(const Arc& arc, std::int64_t path_speed);

}  // namespace axisgate::stage
