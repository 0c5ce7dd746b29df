// Tests of each condition for NG that the manual names: the device refuses and the gateway gives the reason, or the
// gateway refuses beforehand.
#include "device/shrc203/command/refusals.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using simulator::AxisError;
using std::chrono::seconds;

struct Condition {
  std::string name;
  std::function<void(World&)> brought_about;
  std::vector<std::string> lines;
  Reason reason;
};

std::function<void(World&)> error(AxisError error) {
  return [error](World& world) { world.device().set_error(1, error, true, world.now()); };
}

// Sends a line as if from another cable: the device's answers do not reach the gateway.
void behind_its_back(World& world, const std::string& line) {
  world.wire().set_script([](LineKind kind, const std::string&) -> Scripted {
    return {kind == LineKind::reply, {}, {}};
  });
  world.device().receive(line + "\r\n", world.now());
  world.run_for(std::chrono::milliseconds(20));
  world.wire().set_script({});
}

std::vector<Condition> conditions() {
  const std::vector<std::string> move = {"M:1+P100", "G:1"}, line = {"K:A+P100+P100", "G:A"};
  const auto nothing = [](World&) {};
  return {
      {"emergency stop", [](World& world) { world.device().press_emergency(world.now()); }, move,
       Reason::emergency_stopped},
      {"scale error S1", error(AxisError::scale), move, Reason::device_error},
      {"disconnection error S2", error(AxisError::disconnection), move, Reason::device_error},
      {"hunting error S3", error(AxisError::hunting), move, Reason::device_error},
      {"overflow error S4", error(AxisError::overflow), move, Reason::device_error},
      {"system error S7", error(AxisError::system), move, Reason::device_error},
      {"overheat error S10", error(AxisError::overheat), move, Reason::device_error},
      {"motor excitation is OFF", [](World& world) { world.device().set_excitation(1, false, world.now()); }, move,
       Reason::not_excited},
      {"motor excitation is OFF, asked to set",
       [](World& world) { world.device().set_excitation(1, false, world.now()); },
       {"R:1"},
       Reason::not_excited},
      {"asleep", [](World& world) { world.device().set_sleep(true, world.now()); }, move, Reason::not_excited},
      {"the limit sensor is detected", [](World& world) { world.device().set_limit(1, 1, true, world.now()); }, line,
       Reason::limit_detected},
      {"all points on a straight line", nothing, {"E:2A0+P100+P100+P200+P200", "G:A"}, Reason::invalid_request},
      {"out of range", nothing, {"D:1S100F50R100"}, Reason::out_of_range},
      {"nothing set before G", nothing, {"G:1"}, Reason::incomplete_transaction},
      {"nothing registered", nothing, {"PIT:G,5"}, Reason::not_found},
      {"axis not controllable", nothing, {"M:3+P100", "G:3"}, Reason::unknown_axis},
  };
}

class Refused : public testing::TestWithParam<Condition> {};

TEST_P(Refused, ForTheReasonThatItIs) {
  auto setup = quiet();
  const bool two_axes = GetParam().reason == Reason::unknown_axis;
  if (two_axes) setup.options.axis_setting = 3;
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  GetParam().brought_about(world);
  const auto told = execute(world, GetParam().lines);
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back(), name(GetParam().reason)) << GetParam().name << world.replay();
  std::printf("| %s | %s |\n", GetParam().name.c_str(), told.back().c_str());
}

INSTANTIATE_TEST_SUITE_P(Conditions, Refused, testing::ValuesIn(conditions()), [](const auto& one) {
  std::string name;
  for (const char c : one.param.name) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

// "In the case of Busy": a person at the front panel moves the axis, and the gateway has not read the status yet.
TEST(WhyNg, BusyIsTold) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  behind_its_back(world, "J:1+");
  behind_its_back(world, "G:1");
  ASSERT_TRUE(world.device().busy(1));
  EXPECT_EQ(execute(world, {"D:1S100F1000R100"}).back(), "AXIS_BUSY") << world.replay();
}

TEST(WhyNg, AStaleSetpointPrebufferIsTold) {
  World world(quiet());
  foreign_traffic(world, {"MP:2+P100"});
  ASSERT_TRUE(world.run_until_up());
  EXPECT_EQ(execute(world, {"M:1+P100", "G:1"}).back(), "STALE_SETPOINT") << world.replay();
}

TEST(WhyNg, TheModeIsTold) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  world.device().set_mode("MANUAL", world.now());
  EXPECT_EQ(execute(world, {"BEEP:0"}).back(), "WRONG_MODE") << world.replay();
}

// A refusal stays unexplained only if no question can explain it; the message then states everything known.
TEST(WhyNg, WhatNothingTellsIsUnexplained) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  world.wire().set_script([](LineKind kind, const std::string& line) -> Scripted {
    if (kind == LineKind::reply && line == "OK") return {false, {}, "NG\r\n"};
    return {};
  });
  Problem problem;
  world.controller().execute({{"BEEP:0"}, world.context("anna")}, world.now(), [&](const ExecuteEvent& event) {
    if (event.problem) problem = *event.problem;
  });
  world.run_for(seconds(5));
  EXPECT_EQ(problem.reason, Reason::unexplained) << world.replay();
  EXPECT_NE(problem.message.find("axis 1 is READY, its motor is on"), std::string::npos) << problem.message;
}

// A known condition is read again, since a person may have fixed it; if it persists, nothing is sent.
TEST(WhyNg, NothingIsSentWhereAMotorIsKnownToBeOff) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  execute(world, {"C:10"});
  move_by(world, {{1, 100}});
  world.run_for(seconds(2));
  EXPECT_EQ(reason_of(world.outcomes().back()), Reason::not_excited) << world.replay();
  EXPECT_EQ(written(world, "MP:"), 0) << world.replay();
  world.device().set_excitation(1, true, world.now());
  moved(world, {{1, 100}});
}

// One table explains all conditions, and each of its rows has a hint.
TEST(WhyNg, EveryConditionSaysWhatToDo) {
  for (const AxisCondition& condition : axis_conditions()) {
    EXPECT_FALSE(condition.what.empty() || condition.hint.empty()) << condition.name;
    EXPECT_NE(condition.reason, Reason::unspecified) << condition.name;
  }
}

}  // namespace
}  // namespace axisgate::simulation
