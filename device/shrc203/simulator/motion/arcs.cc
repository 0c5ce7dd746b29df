#include "device/shrc203/simulator/motion/arcs.h"

#include <cmath>
#include <numbers>

namespace axisgate::shrc203::simulator {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

struct Point {
  double x = 0;
  double y = 0;
};

Point point_at(const Arc& arc, std::size_t index) {
  return {static_cast<double>(arc.points[index]), static_cast<double>(arc.points[index + 1])};
}

double degrees_of(const Number& number) { return static_cast<double>(number.digits) / std::pow(10.0, number.decimals); }

// Returns the center of the circle through the present position, which is 0,0, and both points.
Point center_of(const Point& passing, const Point& end) {
  const double cross = 2 * (passing.x * end.y - passing.y * end.x);
  const double p = passing.x * passing.x + passing.y * passing.y;
  const double e = end.x * end.x + end.y * end.y;
  return {(p * end.y - e * passing.y) / cross, (e * passing.x - p * end.x) / cross};
}

struct Circle {
  Point center;
  double start = 0;  // radians
  double sweep = 0;  // radians, negative for CW
};

// E:0, E:1, E:3 and E:4. With X to the right and Y up, the angle decreases for CW.
Circle around(const Arc& arc) {
  const Point center = point_at(arc, 0);
  const double sense = arc.direction == 0 ? -1 : 1;
  const double angle = arc.angle ? degrees_of(*arc.angle) / 360 * kTurn : kTurn * arc.turns.value_or(1);
  return {center, std::atan2(-center.y, -center.x), sense * angle};
}

// E:2 and E:5. The manual's two examples have the same direction, although the arcs through their points turn CW and
// CCW (manual 73), 76)): the passing point decides.
Circle through(const Arc& arc) {
  const Point passing = point_at(arc, 0);
  const Point end = point_at(arc, 2);
  const Point center = center_of(passing, end);
  const double start = std::atan2(-center.y, -center.x);
  double sweep = std::atan2(end.y - center.y, end.x - center.x) - start;
  const bool left = passing.x * end.y - passing.y * end.x > 0;
  if (left && sweep <= 0) sweep += kTurn;
  if (!left && sweep >= 0) sweep -= kTurn;
  return {center, start, sweep};
}

// Manual 74): the amount is for one rotation. Manual 75): likewise from one whole rotation on.
std::int64_t linear_of(const Arc& arc) {
  const std::int64_t amount = arc.points.back();
  if (arc.turns) return amount * *arc.turns;
  if (!arc.angle) return amount;
  const double degrees = degrees_of(*arc.angle);
  return degrees < 360 ? amount : std::llround(static_cast<double>(amount) * degrees / 360);
}

}  // namespace

ArcPath path_of(const Arc& arc) {
  const bool has_passing_point = arc.points.size() >= 4;
  const Circle circle = has_passing_point ? through(arc) : around(arc);
  const double radius = std::hypot(circle.center.x, circle.center.y);
  ArcPath path;
  // The sine of an angle is the cosine of the angle minus a quarter turn.
  path.plane[0] = {radius, circle.start, circle.sweep, 0};
  path.plane[1] = {radius, circle.start - kTurn / 4, circle.sweep, 0};
  if (has_passing_point) {
    for (const std::size_t i : {0u, 1u}) path.plane[i].end = arc.points[2 + i];
  } else if (arc.angle) {
    for (Curve& curve : path.plane) {
      curve.end = std::llround(radius * (std::cos(curve.phase + curve.sweep) - std::cos(curve.phase)));
    }
  }
  path.helical = arc.points.size() % 2 == 1;
  if (path.helical) path.linear = linear_of(arc);
  path.length = std::hypot(radius * circle.sweep, static_cast<double>(path.linear));
  return path;
}

}  // namespace axisgate::shrc203::simulator
