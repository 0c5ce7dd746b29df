// Hazard 24: permanent changes of memory switches are reported, with the caller who made them.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::seconds;
using Lines = std::vector<std::string>;

std::vector<SwitchesChanged> switches_told(World& world, const Lines& lines) {
  std::vector<SwitchesChanged> told;
  world.on_news = [&](const Event& event) {
    if (const auto* changed = std::get_if<SwitchesChanged>(&event)) told.push_back(*changed);
  };
  (void)execute(world, lines);
  world.run_for(seconds(10));
  return told;
}

TEST(Hazard, H24_TheDifferenceIsTold) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const auto told = switches_told(world, {"MS:ON", "MS:SET,0,3,0", "MS:SET,5,4,777", "MS:SET,5,4,778", "MS:OFF"});
  ASSERT_EQ(told.size(), 1U) << world.replay();
  EXPECT_EQ(told[0].who, "tester");
  EXPECT_FALSE(told[0].unknown);
  ASSERT_EQ(told[0].changes.size(), 2U) << world.replay();
  const auto& beep = told[0].changes[0];
  EXPECT_EQ(std::tuple(beep.item, beep.number, beep.before, beep.after), std::tuple(0, 3, "1", "0"));
  const auto& speed = told[0].changes[1];
  EXPECT_EQ(std::tuple(speed.item, speed.number, speed.after), std::tuple(5, 4, "778"));
}

// The switches are read until two answers agree, at most four times; otherwise nothing is changed.
TEST(Hazard, H24_ADamagedAnswerIsAskedForAgain) {
  for (const int damaged : {2, 3}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    int answers = 0;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      const bool asked = kind == LineKind::reply && world.wire().commands().back() == "MS:GETK,5";
      if (!asked || ++answers > damaged) return {};
      return {.drop = false, .delay = {}, .instead = std::to_string(answers) + line + "\r\n"};
    });
    const auto told = switches_told(world, {"MS:ON", "MS:SET,5,4,777", "MS:OFF"});
    EXPECT_EQ(told.size(), damaged == 2 ? 1U : 0U) << world.replay();
    EXPECT_EQ(written(world, "MS:SET"), damaged == 2 ? 1 : 0) << world.replay();
  }
}

TEST(Hazard, H24_WhatIsSetAsItWasIsNoDifference) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_TRUE(switches_told(world, {"MS:ON", "MS:GET,0,4", "MS:OFF"}).empty()) << world.replay();
  EXPECT_TRUE(switches_told(world, {"MS:ON", "MS:SET,5,4,777", "MS:DEF,5,4", "MS:OFF"}).empty()) << world.replay();
}

// The return to HOST saves settings made before the line was lost.
TEST(Hazard, H24_ADifferenceThatNobodyCanTell) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  std::vector<SwitchesChanged> told;
  world.on_news = [&](const Event& event) {
    if (const auto* changed = std::get_if<SwitchesChanged>(&event)) told.push_back(*changed);
  };
  world.controller().execute({{"MS:ON", "MS:SET,5,4,777", "MS:OFF"}, world.context("admin")}, world.now(),
                             [](const ExecuteEvent&) {});
  ASSERT_TRUE(world.run_until([&] { return written(world, "MS:SET") == 1; }, seconds(5))) << world.replay();
  world.wire().cut(world.now(), seconds(1));
  world.run_for(seconds(5));
  ASSERT_EQ(told.size(), 1U) << world.replay();
  EXPECT_TRUE(told[0].unknown);
}

}  // namespace
}  // namespace axisgate::simulation
