// Times of straight moves, by closed forms and by a slow exact reference (device/rml1/planner.h).
#include "device/rml1/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

constexpr double kAcceleration = 100, kCorner = 0.02;

struct Leg {
  Point way;
  double speed = 10;
  double arrival = 0;
};

double seconds(const std::vector<Leg>& legs, double corner = kCorner) {
  Planner planner(kAcceleration, corner);
  for (const Leg& leg : legs) planner.move(leg.way, leg.speed, leg.arrival);
  return planner.finish();
}

// The way of speeding up and of slowing down is v / a long each: the whole is L / v + v / a.
double trapezoid(double length, double speed) { return length / speed + speed / kAcceleration; }
// The speed is never reached: half of the way up, half down.
double triangle(double length) { return 2 * std::sqrt(length / kAcceleration); }

TEST(Planner, DrivesATrapezoid) {
  EXPECT_NEAR(seconds({{{5, 0, 0}}}), 0.6, 1e-12);  // 5 / 10 + 10 / 100
  EXPECT_NEAR(seconds({{{0, 3, 4}}}), 0.6, 1e-12);
  EXPECT_NEAR(seconds({{{0, 3, 4}}}, {}), 0.6, 1e-12);
}

TEST(Planner, DrivesATriangleWhereTheWayIsShort) {
  EXPECT_NEAR(seconds({{{0.25, 0, 0}}}), 0.1, 1e-12);  // 2 * sqrt(0.25 / 100)
  EXPECT_NEAR(seconds({{{0, 0, -0.25}}}, {}), 0.1, 1e-12);
  // v^2 / a = 1: from there on the speed is reached.
  EXPECT_NEAR(seconds({{{1, 0, 0}}}), triangle(1), 1e-12);
  EXPECT_NEAR(seconds({{{1, 0, 0}}}), trapezoid(1, 10), 1e-12);
}

TEST(Planner, TakesPiecesInOneLineAsOneMove) {
  EXPECT_NEAR(seconds({{{1, 2, 2}}, {{2, 4, 4}}, {{0.1, 0.2, 0.2}}}), trapezoid(9.3, 10), 1e-9);
  EXPECT_NEAR(seconds(std::vector<Leg>(1000, {{0.03, 0, 0}})), trapezoid(30, 10), 1e-9);
}

TEST(Planner, StopsAtACornerThatMayNotBeCut) { EXPECT_NEAR(seconds({{{5, 0, 0}}, {{0, 5, 0}}}, 0), 1.2, 1e-12); }

TEST(Planner, StopsForAReversal) {
  EXPECT_NEAR(seconds({{{5, 0, 0}}, {{-5, 0, 0}}}), 1.2, 1e-9);
  EXPECT_NEAR(seconds({{{0, 0, 0.25}}, {{0, 0, -0.25}}}), 0.2, 1e-9);
}

// A right angle: half of it has the sine s = sqrt(1/2), and v^2 = 100 * 0.02 * s / (1 - s) = 4.828. Each leg loses
// less than with a stop: L / v + (v - c)^2 / (2 a v) + v / (2 a).
TEST(Planner, TakesACornerWithTheSpeedOfItsArc) {
  const double c = std::sqrt(2 * std::sqrt(0.5) / (1 - std::sqrt(0.5)));
  EXPECT_NEAR(c, 2.1974, 1e-4);
  const double leg = 0.5 + (10 - c) * (10 - c) / 2000 + 0.05;
  EXPECT_NEAR(seconds({{{5, 0, 0}}, {{0, 5, 0}}}), 2 * leg, 1e-12);
  EXPECT_NEAR(seconds({{{0, 5, 0}}, {{0, 0, -5}}}), 2 * leg, 1e-12);
}

// The legs enclose 60 degrees: the sine of half of it is 1/2, and v^2 = 100 * 0.02 * 1 = 2.
TEST(Planner, TakesASharpCornerSlower) {
  const double c = std::sqrt(2.0);
  const double leg = 0.5 + (10 - c) * (10 - c) / 2000 + 0.05;
  EXPECT_NEAR(seconds({{{5, 0, 0}}, {{-2.5, 5 * std::sqrt(0.75), 0}}}), 2 * leg, 1e-9);
}

// The corner would allow 2.197: the slower of the two moves is at 1.
TEST(Planner, TakesACornerNoFasterThanTheSlowerMove) {
  const double slow = 5 + 0.005, fast = 0.5 + 81.0 / 2000 + 0.05;
  EXPECT_NEAR(seconds({{{5, 0, 0}, 1}, {{0, 5, 0}, 10}}), slow + fast, 1e-9);
}

TEST(Planner, SlowsDownInTimeForASlowMove) {
  // 10 down to 2 in the first: 5 / 10 + 8^2 / 2000 + 0.05; 2 to rest in the second: 5 / 2 + 0.01.
  EXPECT_NEAR(seconds({{{5, 0, 0}, 10}, {{5, 0, 0}, 2}}), 0.582 + 2.51, 1e-9);
}

TEST(Planner, WaitsForTheBytesOfAMove) {
  EXPECT_NEAR(seconds({{{5, 0, 0}, 10, 3}}), 3.6, 1e-12);
  EXPECT_NEAR(seconds({{{5, 0, 0}, 10, 3}}, {}), 3.6, 1e-12);
  EXPECT_NEAR(seconds({{{5, 0, 0}}, {{-5, 0, 0}, 10, 0.2}}), 1.2, 1e-9) << "they have come before it begins";
  EXPECT_NEAR(seconds({{{5, 0, 0}}, {{-5, 0, 0}, 10, 2}}), 2.6, 1e-9);
  EXPECT_NEAR(seconds({{{5, 0, 0}}, {{-5, 0, 0}, 10, 2}}, {}), 2.6, 1e-9);
}

TEST(Planner, StandsStillForAPause) {
  for (const double corner : {kCorner, 0.0}) {
    Planner planner(kAcceleration, corner);
    planner.pause(1, 0);
    planner.move({5, 0, 0}, 10, 0);
    planner.pause(2, 0);
    planner.move({5, 0, 0}, 10, 0);
    EXPECT_NEAR(planner.finish(), 3 + 2 * 0.6, 1e-9);
  }
}

TEST(Planner, TakesNoTimeForNothing) { EXPECT_EQ(seconds({}), 0); }

// Knows the whole chain, and looks for each speed from both ends.
class Reference {
 public:
  explicit Reference(const std::vector<Leg>& legs) {
    std::vector<double> speed(legs.size() + 1, 0);
    for (std::size_t at = 1; at < legs.size(); ++at) speed[at] = corner(legs[at - 1], legs[at]);
    for (std::size_t at = 0; at < legs.size(); ++at)
      speed[at + 1] = std::min(speed[at + 1], reach(speed[at], legs[at]));
    for (std::size_t at = legs.size(); at-- > 0;) speed[at] = std::min(speed[at], reach(speed[at + 1], legs[at]));
    for (std::size_t at = 0; at < legs.size(); ++at) seconds_ += time(speed[at], speed[at + 1], legs[at]);
  }
  double seconds() const { return seconds_; }

 private:
  // The legs enclose an angle: an arc of radius r which touches both comes to r (1 / sin(half) - 1) of the corner.
  static double corner(const Leg& before, const Leg& after) {
    const Point back = before.way * (-1 / length(before.way)), on = after.way * (1 / length(after.way));
    const double half = std::acos(std::clamp(back.x * on.x + back.y * on.y + back.z * on.z, -1.0, 1.0)) / 2;
    const double slower = std::min(before.speed, after.speed);
    if (half > 1.5692) return slower;  // straight on
    const double radius = kCorner / (1 / std::sin(half) - 1);
    return std::min(slower, std::sqrt(kAcceleration * radius));
  }
  static double reach(double speed, const Leg& leg) {
    return std::sqrt(speed * speed + 2 * kAcceleration * length(leg.way));
  }
  // The highest speed by halving: what it takes to reach it and to come down from it must fit.
  static double time(double entry, double exit, const Leg& leg) {
    const double way = length(leg.way);
    const auto ramps = [&](double top) { return (2 * top * top - entry * entry - exit * exit) / 2 / kAcceleration; };
    double low = std::max(entry, exit), high = std::max(low, leg.speed);
    for (int step = 0; step < 100; ++step) {
      const double middle = (low + high) / 2;
      (ramps(middle) <= way ? low : high) = middle;
    }
    return (2 * low - entry - exit) / kAcceleration + std::max(0.0, way - ramps(low)) / low;
  }

  double seconds_ = 0;
};

// Legs from `shortest` to `longest` mm, some of them straight on or back.
std::vector<Leg> chain(unsigned seed, double shortest, double longest) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1, 1), way(shortest, longest), speed(0.5, 15);
  std::vector<Leg> legs;
  for (int index = 0; index < 3000; ++index) {
    Point direction{part(random), part(random), part(random) / 4};
    if (index > 0 && random() % 4 == 0) direction = legs.back().way * (random() % 2 == 0 ? 1 : -1);
    legs.push_back({direction * (way(random) / length(direction)), speed(random)});
  }
  return legs;
}

// 15 mm/s are reached on 1.125 mm: 64 moves ahead are enough for what is exact.
TEST(Planner, IsAsFastAsTheReference) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const std::vector<Leg> legs = chain(seed, 0.02, 3);
    const double exact = Reference(legs).seconds();
    EXPECT_NEAR(seconds(legs), exact, exact * 1e-6) << seed;
  }
}

// It must be able to stop 64 moves further on, 0.064 mm: it may be slower than the reference, never faster.
TEST(Planner, IsNoFasterThanTheReferenceWithTinyMoves) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const std::vector<Leg> legs = chain(seed, 0.0001, 0.001);
    const double low = seconds(legs);
    EXPECT_GE(low, Reference(legs).seconds() * (1 - 1e-9)) << seed;
    EXPECT_LE(low, seconds(legs, {})) << seed;
  }
}

TEST(Planner, LowEndIsNeverAboveTheHighEnd) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const double longest = std::pow(10, static_cast<int>(seed % 5) - 2);
    Planner low(kAcceleration * (1 + seed % 3), kCorner), high(kAcceleration, kCorner, 1.5);
    double arrival = 0;
    for (const Leg& leg : chain(seed, longest / 100, longest)) {
      arrival += static_cast<double>(random() % 1000) * longest / 2e4;
      for (Planner* planner : {&low, &high}) {
        planner->move(leg.way, leg.speed, arrival);
        if (leg.speed > 14.5) planner->pause(0.25, 0);
      }
    }
    const double least = low.finish(), most = high.finish();
    EXPECT_LE(least, most) << seed;
    EXPECT_GE(least, arrival) << seed;
  }
}

// 10 bits a byte: "PD;" and 297 blanks are 3000 bits, the next command has come after 3060.
TEST(Planner, HearsOfTheLineFromCheck) {
  Profile profile = test_profile();
  profile.baud = 300;
  profile.spindle.spin_up_s = 0;
  const auto check = checked("PD;" + std::string(297, ' ') + "PU;PD;", profile);
  EXPECT_GE(check->summary().seconds_low, 10.1);
}

}  // namespace
}  // namespace axisgate::rml1
