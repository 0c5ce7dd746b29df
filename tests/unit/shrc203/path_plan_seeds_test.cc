// Path segments against closed-form geometry: the line that is sent is read back by hand, its curve is followed point
// by point, and the points are compared with the planned end and the travel limits. All axis pairs, directions,
// displacements and places; thousands of cases from fixed seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <regex>
#include <string>
#include <vector>

#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/planning/refill_feasibility.h"
#include "tests/simulation/random.h"

namespace axisgate::shrc203::path_plan_seeds_test {
namespace {

using simulation::Random;
using Place = std::array<double, kAxisCount>;

constexpr int kCases = 4000, kSamples = 360;

// Kind, axes and numbers of a line: "EP:1A0+P30-P40D90" has kind 1, axes A and the numbers 0, 30, -40 and 90.
struct Line {
  char kind = 0;  // a digit, or K
  char axes = 0;
  std::vector<double> numbers;
};

Line read_line(const std::string& text) {
  Line line;
  const bool curve = text.starts_with("EP:");
  line.kind = curve ? text[3] : text.front();
  line.axes = curve ? text[4] : text[3];
  const std::string rest = text.substr(curve ? 5 : 4, text.find(',') - (curve ? 5 : 4));
  // A curve begins with the digit of its direction, sometimes followed by N and a number of turns; then come the
  // amounts, then D and an angle.
  static const std::regex kNumber("([+-]?)P?([0-9.]+)");
  std::string apart = rest;
  if (curve) {
    line.numbers.push_back(rest[0] - '0');
    apart = rest.substr(1);
  }
  for (std::sregex_iterator it(apart.begin(), apart.end(), kNumber), end; it != end; ++it) {
    line.numbers.push_back(((*it)[1] == "-" ? -1 : 1) * std::stod((*it)[2]));
  }
  return line;
}

std::array<std::size_t, 2> plane_of(char axes) {
  if (axes == 'B') return {0, 2};
  if (axes == 'C') return {1, 2};
  return {0, 1};
}

// Returns points around the center x, y over an angle in degrees, counterclockwise above 0 (manual 71), 72), 74), 75)).
std::vector<Place> turned(double x, double y, double degrees, double rise, std::array<std::size_t, 2> plane) {
  std::vector<Place> places;
  for (int i = 0; i <= kSamples; ++i) {
    const double part = static_cast<double>(i) / kSamples, angle = degrees * part * std::numbers::pi / 180;
    Place place{};
    place[plane[0]] = x - x * std::cos(angle) + y * std::sin(angle);
    place[plane[1]] = y - x * std::sin(angle) - y * std::cos(angle);
    if (rise != 0) place[2] = rise * part;
    places.push_back(place);
  }
  return places;
}

// Returns points through a passing point to an end (manual 73), 76)): the center is equally far from all three points.
std::vector<Place> led_through(const std::vector<double>& n, double rise, std::array<std::size_t, 2> plane) {
  const double px = n[0], py = n[1], ex = n[2], ey = n[3], cross = 2 * (px * ey - py * ex);
  const double p = px * px + py * py, e = ex * ex + ey * ey;
  const double x = (ey * p - py * e) / cross, y = (px * e - ex * p) / cross;
  const auto bearing = [&](double at_x, double at_y) {
    const double turn = std::atan2(at_y - y, at_x - x) - std::atan2(-y, -x);
    return turn < 0 ? turn + 2 * std::numbers::pi : turn;
  };
  const double to_point = bearing(px, py), to_end = bearing(ex, ey);
  const double sweep = to_point < to_end ? to_end : to_end - 2 * std::numbers::pi;
  return turned(x, y, sweep * 180 / std::numbers::pi, rise, plane);
}

std::vector<Place> walked(const Line& line) {
  const auto& n = line.numbers;
  const auto plane = plane_of(line.axes);
  const double sense = line.kind != 'K' && n[0] == 0 ? -1 : 1;
  switch (line.kind) {
    case '0':
      return turned(n[1], n[2], sense * 360, 0, plane);
    case '1':
      return turned(n[1], n[2], sense * n[3], 0, plane);
    case '2':
      return led_through({n[1], n[2], n[3], n[4]}, 0, plane);
    case '3':
      return turned(n[2], n[3], sense * 360 * n[1], n[4] * n[1], plane);
    case '4':
      return turned(n[1], n[2], sense * n[3], n[4] * std::max(1.0, n[3] / 360), plane);
    case '5':
      return led_through({n[1], n[2], n[3], n[4]}, n[5], plane);
    default: {
      Place end{};
      for (std::size_t i = 0; i < n.size(); ++i) end[line.axes == 'D' ? i : plane[i]] = n[i];
      return {{}, end};
    }
  }
}

std::int64_t amount(Random& random) {
  const std::int64_t size = random.between(1, 5000);
  return random.chance(0.5) ? size : -size;
}

Segment drawn(Random& random, const Positions& from) {
  const std::array<std::array<int, 2>, 3> planes = {{{1, 2}, {1, 3}, {2, 3}}};
  const auto plane = planes[static_cast<std::size_t>(random.between(0, 2))];
  Segment segment;
  segment.relative = random.chance(0.5);
  const auto place = [&](int axis) {
    return pulses(amount(random) + (segment.relative ? 0 : *from[static_cast<std::size_t>(axis - 1)]));
  };
  if (random.chance(0.2)) {
    for (const int axis : plane) segment.moves.push_back({axis, place(axis), {}});
    return segment;
  }
  Curve curve{{}, Curve::Through{}, {}};
  const bool helix = random.chance(0.4);
  curve.axes = helix ? std::array{1, 2} : plane;
  if (helix) curve.rise = pulses(amount(random));
  const auto point = [&] { return std::array{place(curve.axes[0]), place(curve.axes[1])}; };
  if (random.chance(0.4)) {
    curve.course = Curve::Through{point(), point()};
  } else {
    Curve::Around around{point(), random.chance(0.5) ? Rotation::clockwise : Rotation::counterclockwise, 1};
    if (random.chance(0.5)) {
      around.extent = Decimal{random.between(1, helix ? 36'000 : 3600), 1};
    } else if (helix) {
      around.extent = static_cast<int>(random.between(1, 9));
    }
    curve.course = around;
  }
  segment.curve = curve;
  return segment;
}

class PlannedSegments : public testing::TestWithParam<int> {};

TEST_P(PlannedSegments, AreWhatTheirLinesSay) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  int planned_cases = 0, refused_cases = 0;
  for (int i = 0; i < kCases / 8; ++i) {
    Profile profile;
    State state;
    for (const int number : kAllAxes.list()) {
      auto& axis = state.axis(number);
      axis.controllable = true;
      axis.scale = Scale{{10, 0}, false};
      axis.position_pulses = random.between(-3000, 3000);
      axis.minimum_speed = 1000;
      axis.maximum_speed = 50'000;
      axis.acceleration_ms = 100;
    }
    const Positions from = positions_of(state);
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      profile.axes[axis].travel_minimum = pulses(*from[axis] - random.between(1, 9000));
      profile.axes[axis].travel_maximum = pulses(*from[axis] + random.between(1, 9000));
    }
    const Segment segment = drawn(random, from);
    const PathRequest request{{segment}, {}};
    Profile boundless;
    const auto free = plan_path(request, from, Envelope(boundless, state, "tester", "operator"));
    if (!free) continue;  // the three points are on a line
    const std::string text = segment_setter(*free, 1).line;
    const auto places = walked(read_line(text));
    const auto bounded = plan_path(request, from, Envelope(profile, state, "tester", "operator"));
    bool outside = false, nearly = false;
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      const auto begin = static_cast<double>(*from[axis]);
      EXPECT_NEAR(static_cast<double>(free->segments[0].end[axis]), begin + places.back()[axis], 0.6) << text;
      for (const Place& place : places) {
        const double at = begin + place[axis];
        const auto lowest = static_cast<double>(profile.axes[axis].travel_minimum->value.digits);
        const auto highest = static_cast<double>(profile.axes[axis].travel_maximum->value.digits);
        outside = outside || at < lowest - 1 || at > highest + 1;
        nearly = nearly || at < lowest + 2 || at > highest - 2;
      }
    }
    const bool right = bounded ? !outside : nearly;
    EXPECT_TRUE(right) << text << ": " << (bounded ? "allowed" : bounded.error().message);
    ++(bounded ? planned_cases : refused_cases);
  }
  EXPECT_GT(planned_cases, kCases / 80) << "hardly any was allowed";
  EXPECT_GT(refused_cases, kCases / 80) << "hardly any was refused";
}

INSTANTIATE_TEST_SUITE_P(Cases, PlannedSegments, testing::Range(1, 9));

}  // namespace
}  // namespace axisgate::shrc203::path_plan_seeds_test
