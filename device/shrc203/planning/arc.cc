#include "device/shrc203/planning/arc.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/core/quantity.h"

namespace axisgate::shrc203 {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kQuarter = kPi / 2;

constexpr double kArcDegreesMax = 360;       // manual 72) E:1
constexpr double kHelixDegreesMax = 360000;  // manual 75) E:4
constexpr int kTurnsMax = 1000;              // manual 74) E:3

// Longest distance from the start to any point of a curve within the counter's range.
constexpr double kReachMax = 2.0 * static_cast<double>(kPulsesMax);

// Tolerance in pulses: larger than the rounding error of doubles for a curve within kReachMax, and too small to matter.
constexpr double kRemainder = 1e-3;

constexpr double kSecondsMax = 1e9;  // upper limit, well within the range of Duration

// Displacement from the start of the curve, in pulses.
struct Way {
  double first = 0;
  double second = 0;
};

double norm(PlanePoint point) {
  return std::hypot(static_cast<double>(point.first), static_cast<double>(point.second));
}

// The curve starts at a right angle to the center, which lies to its left if the curve turns counterclockwise.
Arc around(PlanePoint center, double degrees, Rotation rotation) {
  const double sense = rotation == Rotation::clockwise ? -1 : 1;
  const double heading =
      std::atan2(-sense * static_cast<double>(center.first), sense * static_cast<double>(center.second));
  return {norm(center), heading, sense * degrees / 180 * kPi, 0};
}

Result<Arc> by_angle(PlanePoint center, double degrees, Rotation rotation, double degrees_max, const char* where) {
  if (degrees > 0 && degrees <= degrees_max) return around(center, degrees, rotation);
  return fail(Reason::out_of_range, fmt::format("an arc of {} degrees; above 0 and up to {} are possible (manual {})",
                                                degrees, degrees_max, where));
}

// The direction of a chord lies halfway between the curve's directions at the chord's ends.
Way way_after(const Arc& arc, double turned) {
  const double chord = 2 * arc.radius * std::sin(std::abs(turned) / 2);
  const double direction = arc.heading + turned / 2;
  return {chord * std::cos(direction), chord * std::sin(direction)};
}

struct Span {
  double lowest = 0;
  double highest = 0;

  void take(double value) {
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  bool within(double reach) const { return lowest >= -reach && highest <= reach; }
  Extent rounded() const {
    return {std::llround(std::floor(lowest + kRemainder)), std::llround(std::ceil(highest - kRemainder))};
  }
};

struct PlaneSpan {
  Span first, second;

  void take(Way way) {
    first.take(way.first);
    second.take(way.second);
  }
};

// An axis turns back at each point where the curve runs parallel to the other axis: its direction there is a whole
// number of quarter turns.
PlaneSpan span_of(const Arc& arc) {
  PlaneSpan span;
  span.take(way_after(arc, arc.sweep));
  const double sense = std::copysign(1.0, arc.sweep);
  double quarters = sense * std::ceil(sense * arc.heading / kQuarter);
  for (int i = 0; i < 4; ++i, quarters += sense) {
    const double turned = quarters * kQuarter - arc.heading;
    if (std::abs(turned) >= std::abs(arc.sweep)) break;
    span.take(way_after(arc, turned));
  }
  return span;
}

Result<Arc> within_reach(const Arc& arc) {
  const PlaneSpan span = span_of(arc);
  if (span.first.within(kReachMax) && span.second.within(kReachMax)) return arc;
  return fail(Reason::out_of_range,
              fmt::format("an arc of a circle {:.3g} pulses wide leads beyond what the controller counts, {} pulses",
                          2 * arc.radius, kPulsesMax),
              "choose points further from one line");
}

}  // namespace

Arc whole_circle(PlanePoint center, Rotation rotation) { return around(center, 360, rotation); }

Result<Arc> arc_by_angle(PlanePoint center, double degrees, Rotation rotation) {
  return by_angle(center, degrees, rotation, kArcDegreesMax, "72) E:1");
}

Result<Arc> arc_through(PlanePoint passing, PlanePoint end) {
  const PlanePoint rest{end.first - passing.first, end.second - passing.second};
  const std::int64_t cross = passing.first * rest.second - passing.second * rest.first;
  const std::int64_t dot = passing.first * rest.first + passing.second * rest.second;
  if (cross == 0) {
    return fail(
        Reason::invalid_request,
        fmt::format("the start, ({}, {}) and ({}, {}), in pulses from it, lie on one line: no arc leads through "
                    "the three points (manual 73) E:2)",
                    passing.first, passing.second, end.first, end.second),
        "give three different points, or a straight line");
  }
  // At the passing point, the direction changes by half of the whole arc's turn (inscribed angle).
  const double half = std::atan2(static_cast<double>(cross), static_cast<double>(dot));
  const double radius = norm(passing) * norm(rest) * norm(end) / (2 * std::abs(static_cast<double>(cross)));
  const double chord = std::atan2(static_cast<double>(end.second), static_cast<double>(end.first));
  return within_reach({radius, chord - half, 2 * half, 0});
}

Result<Arc> helix_of_turns(PlanePoint center, int turns, Rotation rotation, std::int64_t rise_of_turn) {
  if (turns < 1 || turns > kTurnsMax) {
    return fail(Reason::out_of_range,
                fmt::format("a helix of {} turns; 1 to {} are possible (manual 74) E:3)", turns, kTurnsMax));
  }
  Arc arc = around(center, 360.0 * turns, rotation);
  arc.rise = static_cast<double>(rise_of_turn * turns);
  return arc;
}

Result<Arc> helix_by_angle(PlanePoint center, double degrees, Rotation rotation, std::int64_t rise) {
  auto arc = by_angle(center, degrees, rotation, kHelixDegreesMax, "75) E:4");
  if (arc) arc->rise = static_cast<double>(rise) * (degrees < 360 ? 360 : degrees) / 360;
  return arc;
}

Result<Arc> helix_through(PlanePoint passing, PlanePoint end, std::int64_t rise) {
  auto arc = arc_through(passing, end);
  if (arc) arc->rise = static_cast<double>(rise);
  return arc;
}

Rotation rotation_of(const Arc& arc) { return arc.sweep < 0 ? Rotation::clockwise : Rotation::counterclockwise; }

Result<Arc> other_way(const Arc& arc) {
  const double rest = arc.sweep - std::copysign(2 * kPi, arc.sweep);
  return within_reach({arc.radius, arc.heading + kPi, rest, arc.rise});
}

ArcEnd end_of(const Arc& arc) {
  const Way way = way_after(arc, arc.sweep);
  return {std::llround(way.first), std::llround(way.second), std::llround(arc.rise)};
}

bool ends_on_whole_pulses(const Arc& arc) {
  constexpr double kRounding = 1e-6;  // pulses: far above the rounding error of doubles here, far below one half
  const Way way = way_after(arc, arc.sweep);
  const auto whole = [](double place) { return std::abs(place - std::round(place)) < kRounding; };
  return whole(way.first) && whole(way.second) && whole(arc.rise);
}

ArcExtent extent_of(const Arc& arc) {
  const PlaneSpan plane = span_of(arc);
  Span third;
  third.take(arc.rise);
  return {plane.first.rounded(), plane.second.rounded(), third.rounded()};
}

double length_of(const Arc& arc) { return std::hypot(arc.radius * arc.sweep, arc.rise); }

Duration duration_of(const Arc& arc, std::int64_t path_speed) {
  const double seconds = std::min(length_of(arc) / static_cast<double>(path_speed), kSecondsMax);
  return std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

}  // namespace axisgate::shrc203
