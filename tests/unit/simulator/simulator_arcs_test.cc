// Arcs of the simulated SHRC-203 as motion (manual 71) to 82)), against the geometry of the circle.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_arcs_test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kSettling = 5ms;
constexpr double kPi = std::numbers::pi;

double seconds(Duration time) { return std::chrono::duration<double>(time).count(); }

void start(SimulatorBench& bench, std::string_view setting) {
  ASSERT_EQ(bench.ask(setting), "OK") << setting;
  ASSERT_EQ(bench.ask("G"), "OK") << setting;
}

void expect_at(const SimulatorBench& bench, std::int64_t x, std::int64_t y, std::int64_t z) {
  EXPECT_EQ(bench.device.position(1), x);
  EXPECT_EQ(bench.device.position(2), y);
  EXPECT_EQ(bench.device.position(3), z);
}

TEST(SimulatorArcs, APerfectCircleFollowsTheCircleAndEndsWhereItBegan) {
  SimulatorBench bench;
  // Radius 5000 around (0, 5000): from the lowest point, CW goes left first. 31415.9 pulses at 1000 pulses/s.
  start(bench, "E:0A0+P0+P5000");
  for (int i = 1; i <= 31; ++i) {
    bench.wait(1s);
    const double angle = i * 1000.0 / 5000.0;
    EXPECT_EQ(bench.device.position(1), std::llround(-5000 * std::sin(angle))) << i;
    EXPECT_EQ(bench.device.position(2), std::llround(5000 - 5000 * std::cos(angle))) << i;
    EXPECT_EQ(bench.ask("!:S"), "B,B,R");
  }
  EXPECT_EQ(bench.rest(), "");
  EXPECT_NEAR(seconds(bench.elapsed() - kSettling), 2 * kPi * 5, 1e-6);
  expect_at(bench, 0, 0, 0);
  EXPECT_EQ(bench.ask("?:E"), "NS");
}

TEST(SimulatorArcs, CcwGoesTheOtherWay) {
  SimulatorBench bench;
  start(bench, "E:0A1+P0+P5000");
  bench.wait(1s);
  EXPECT_EQ(bench.device.position(1), std::llround(5000 * std::sin(0.2)));
}

TEST(SimulatorArcs, TheManualsCircleTakesItsTime) {
  SimulatorBench bench;
  // Radius 0.05 mm * sqrt(2) around (0.05 mm, -0.05 mm), 10 nm a pulse, at 0.5 mm/s.
  ASSERT_EQ(bench.ask("EP:0A0M0.05-M0.05,S0.5F5R50"), "OK");
  ASSERT_EQ(bench.ask("G:A"), "OK");
  EXPECT_EQ(bench.ask("?:EP"), "NS");
  EXPECT_EQ(bench.ask("?:E"), "0,A,0,5000,-5000");
  EXPECT_EQ(bench.ask("?:D1"), "S50000F500000R50");
  const double whole = 2 * kPi * 5000 * std::sqrt(2.0) / 50000;
  bench.wait(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(whole / 4)));
  expect_at(bench, 10000, 0, 0);  // from the upper left point to the upper right one
  EXPECT_EQ(bench.rest(), "1 2");
  EXPECT_NEAR(seconds(bench.when_last_said()), whole, 1e-6);
  expect_at(bench, 0, 0, 0);
}

TEST(SimulatorArcs, TheManualsAngleEndsThere) {
  SimulatorBench bench;
  // (-100, 200) from the centre, turned CW by 90 degrees, is (200, 100).
  start(bench, "E:1B0+P100-P200D90");
  bench.rest();
  expect_at(bench, 300, 0, -100);
  EXPECT_NEAR(seconds(bench.elapsed() - kSettling), kPi / 2 * std::hypot(100, 200) / 1000, 1e-6);
}

TEST(SimulatorArcs, AnglesHaveDecimalsAndBothSenses) {
  SimulatorBench bench;
  start(bench, "E:1A1-P10000+P0D22.5");
  bench.rest();
  const double angle = 22.5 / 180 * kPi;
  expect_at(bench, std::llround(10000 * (std::cos(angle) - 1)), std::llround(10000 * std::sin(angle)), 0);
  SimulatorBench whole;
  start(whole, "E:1A1-P10000+P0D360");
  whole.wait(10s);
  EXPECT_NE(whole.device.position(1), 0);
  whole.rest();
  expect_at(whole, 0, 0, 0);
}

TEST(SimulatorArcs, ThePassingPointDecidesTheSense) {
  for (const auto* direction : {"0", "1"}) {
    SimulatorBench bench;
    // A quarter of the circle around (1000, 0), from its left point through 45 degrees to its lowest point.
    start(bench, "E:2A" + std::string(direction) + "+P293-P707+P1000-P1000");
    bench.wait(785ms);
    EXPECT_NEAR(static_cast<double>(bench.device.position(1)), 293, 2);
    EXPECT_NEAR(static_cast<double>(bench.device.position(2)), -707, 2);
    bench.rest();
    expect_at(bench, 1000, -1000, 0);
    EXPECT_NEAR(seconds(bench.elapsed() - kSettling), kPi / 2, 2e-3);
  }
}

TEST(SimulatorArcs, TheManualsPassingPointsArePassed) {
  SimulatorBench bench;
  start(bench, "E:2A0+M0.05+M0.03+M0.08+M0.12");
  double nearest = 1e9;
  while (bench.ask("!:") == "B") {
    bench.wait(10ms);
    nearest = std::min(nearest, std::hypot(static_cast<double>(bench.device.position(1)) - 5000,
                                           static_cast<double>(bench.device.position(2)) - 3000));
  }
  EXPECT_LT(nearest, 6);
  expect_at(bench, 8000, 12000, 0);
}

TEST(SimulatorArcs, MoreThanHalfACircleThroughAPoint) {
  SimulatorBench bench;
  // Three quarters of the circle around (1000, 0), CW from its left point through its right one to its lowest point.
  start(bench, "E:2A0+P2000+P0+P1000-P1000");
  bench.wait(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(kPi / 2)));
  expect_at(bench, 1000, 1000, 0);
  bench.rest();
  expect_at(bench, 1000, -1000, 0);
  EXPECT_NEAR(seconds(bench.elapsed() - kSettling), kPi * 1.5, 1e-6);
}

TEST(SimulatorArcs, AHelixTakesTheThirdAxisAlong) {
  SimulatorBench bench;
  start(bench, "E:3A0N2+P0+P5000+P2000");
  const double length = std::hypot(4 * kPi * 5000, 4000);
  bench.wait(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(length / 4000)));
  EXPECT_NEAR(static_cast<double>(bench.device.position(3)), 1000, 1);
  EXPECT_EQ(bench.device.position(2), 10000);
  EXPECT_EQ(bench.ask("!:S"), "B,B,B");
  bench.rest();
  expect_at(bench, 0, 0, 4000);
  EXPECT_NEAR(seconds(bench.elapsed() - kSettling), length / 1000, 1e-6);
}

TEST(SimulatorArcs, ATinyHelixEnds) {
  SimulatorBench bench;
  start(bench, "E:3A1N3+P2+P3-P15");
  bench.rest();
  expect_at(bench, 0, 0, -45);
}

TEST(SimulatorArcs, ALinearAmountIsOfAWholeRotationFromOneOn) {
  SimulatorBench less;
  start(less, "E:4A0+P0+P100D90+P50");
  less.rest();
  expect_at(less, -100, 100, 50);
  SimulatorBench more;
  start(more, "E:4A1+P0+P100D540+P100");
  more.rest();
  expect_at(more, 0, 200, 150);
}

TEST(SimulatorArcs, AHelixThroughAPointEndsExactly) {
  SimulatorBench bench;
  start(bench, "E:5A0-M0.05+M0.03-M0.08+M0.12+M0.1");
  bench.rest();
  expect_at(bench, -8000, 12000, 10000);
}

TEST(SimulatorArcs, CompletionsAreThoseOfLines) {
  for (const auto& [option, told] : {std::pair("each_axis_ascending", "1 2 3"), std::pair("lowest_axis", "1")}) {
    SimulatorBench bench(Settings{{"interpolation_completion", option}});
    ASSERT_EQ(bench.ask("EP:4A0+P0+P100D90+P50,S1000F1000R50"), "OK");
    ASSERT_EQ(bench.ask("G"), "OK");
    EXPECT_EQ(bench.rest(), told);
  }
}

TEST(SimulatorArcs, PrebuffersFollowEachOther) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("EP:1A0+P1000+P0D180"), "OK");
  ASSERT_EQ(bench.ask("G"), "OK");
  ASSERT_EQ(bench.ask("EP:1A1+P1000+P0D180"), "OK_D");
  ASSERT_EQ(bench.ask("EP:2A0+P1000+P1000+P2000+P0"), "OK_D");  // replaces the previous setting
  EXPECT_EQ(bench.rest(), "1 2 1 2");
  expect_at(bench, 4000, 0, 0);
  EXPECT_EQ(bench.device.starts(1), 2);
}

TEST(SimulatorArcs, RefusesWhatIsNoArc) {
  SimulatorBench bench;
  for (const auto* line : {"E:2A0+P10+P10+P20+P20", "E:2A0+P10+P10+P0+P0", "E:2A0+P10+P10+P10+P10",
                           "EP:2A0+P10+P10-P20-P20", "E:5A0+P10+P10+P20+P20+P5", "E:4A0+P0+P100D360000.1+P50",
                           "E:3A0N0+P0+P5000+P2000", "E:3A0N1001+P0+P5000+P2000", "E:6A0+P1+P1"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  ASSERT_EQ(bench.ask("E:0A0+P0+P100"), "OK");
  EXPECT_EQ(bench.ask("G:1"), "NG");
  EXPECT_EQ(bench.ask("G:A"), "OK");
}

TEST(SimulatorArcs, ACentreWhereItStandsIsNoWay) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("EP:0A0+P0+P0"), "OK");
  EXPECT_EQ(bench.ask("G"), "OK 1 2");
  EXPECT_EQ(bench.device.starts(1), 0);
}

TEST(SimulatorArcs, AStopStopsAllOfIt) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("EP:3A0N1+P0+P5000+P2000"), "OK");
  ASSERT_EQ(bench.ask("G"), "OK");
  bench.wait(1s);
  const auto x = bench.device.position(1);
  ASSERT_EQ(bench.ask("L:3"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), x);
  EXPECT_LT(x, 0);
  EXPECT_EQ(bench.ask("!:"), "R");
}

TEST(SimulatorArcs, ALimitSensorStopsAllOfItOnTheWay) {
  Options options;
  options.axes[0].travel_minus_pulses = -2500;  // sin = 1/2: after 30 degrees
  SimulatorBench bench({}, options);
  ASSERT_EQ(bench.ask("EP:0A0+P0+P5000"), "OK");
  ASSERT_EQ(bench.ask("G"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), -2500);
  EXPECT_NEAR(static_cast<double>(bench.device.position(2)), 5000 * (1 - std::cos(kPi / 6)), 1);
  EXPECT_NEAR(seconds(bench.elapsed() - kSettling), 5 * kPi / 6, 1e-3);
  EXPECT_EQ(bench.ask("SRQ:1S"), "100080,R");  // bits 8 and 21
}

TEST(SimulatorArcs, ALimitSensorBesideTheCircleStopsNothing) {
  Options options;
  options.axes[0].travel_minus_pulses = -5001;
  options.axes[1].travel_minus_pulses = -1;
  options.axes[1].travel_plus_pulses = 10001;
  SimulatorBench bench({}, options);
  start(bench, "E:0A0+P0+P5000");
  bench.rest();
  expect_at(bench, 0, 0, 0);
  EXPECT_EQ(bench.ask("SRQ:S"), "1,1,1,R,R,R");
}

TEST(SimulatorArcs, ASensorPushedAheadStopsItWhenItTurnsThere) {
  SimulatorBench bench;
  start(bench, "E:0A0+P0+P5000");  // X goes left first, and turns back after a quarter
  bench.wait(1s);
  bench.device.set_limit(1, 1, true, bench.now());
  EXPECT_EQ(bench.ask("!:"), "B");
  bench.rest();
  expect_at(bench, -5000, 5000, 0);
  EXPECT_NEAR(seconds(bench.elapsed() - kSettling), 5 * kPi / 2, 1e-3);
  SimulatorBench at_once;
  start(at_once, "E:0A0+P0+P5000");
  at_once.wait(1s);
  at_once.device.set_limit(1, -1, true, at_once.now());
  at_once.rest();
  EXPECT_EQ(at_once.elapsed(), 1s + kSettling);
  EXPECT_EQ(at_once.device.position(1), std::llround(-5000 * std::sin(0.2)));
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_arcs_test
