// Tests of the texts of requests in the log.
#include "server/api/request/request_texts.h"

#include <gtest/gtest.h>

#include "server/api/request/audit.h"
#include "tests/api/log.h"
#include "tests/api/world.h"

namespace axisgate::api {
namespace {

constexpr Quantity kFive{{5, 0}, Unit::millimeters}, kBack{{-25, 1}, Unit::micrometers};

TEST(RequestTexts, AMoveHasItsTargets) {
  stage::MoveRequest move;
  move.moves = {{1, kFive, {}, {}}, {3, pulses(100), {}, {}}};
  EXPECT_EQ(text_of(move), "move axis 1 to 5 mm, axis 3 to 100 pulse");
  move.moves = {{2, kBack, {}, {}}};
  move.relative = true;
  EXPECT_EQ(text_of(move), "move axis 2 by -2.5 um");
}

TEST(RequestTexts, OthersHaveWhatTheyAreDoneWith) {
  stage::ScanRequest scan;
  scan.axis = 2;
  scan.from = kBack;
  scan.to = kFive;
  EXPECT_EQ(text_of(scan), "scan axis 2 from -2.5 um to 5 mm");
  stage::JogRequest jog;
  jog.axes = {{1, 1, kFive}, {2, -1, {}}};
  EXPECT_EQ(text_of(jog), "jog axis 1 plus at 5 mm/s, axis 2 minus at its minimum speed");
  EXPECT_EQ(text_of("home", stage::AxisSet::of(2)), "home axis 2");
  EXPECT_EQ(text_of("home", stage::AxisSet()), "home all axes");
  EXPECT_EQ(text_of("change settings", {"D:1,1,2,3", "C:1,1"}), "change settings: D:1,1,2,3 | C:1,1");
}

TEST(RequestTexts, WhatACallerWritesIsEscapedAndCut) {
  World world;
  Log log;
  world.on_strand([&](stage::StageController&, TimePoint) {
    audit(RequestKind::execute, world.device(), {.who = "token scan"},
          "execute: M:1\r\n\x1b[2J" + std::string(500, 'x'));
    audit(RequestKind::get_settings, world.device(), {.who = "token scan"}, "ask");
  });
  EXPECT_TRUE(log.text().starts_with("turn: token scan requests: execute: M:1\\r\\n\\x1B[2Jxx")) << log.text();
  EXPECT_TRUE(log.text().ends_with("x...\n"));
  EXPECT_LT(log.text().size(), 440u);
}

}  // namespace
}  // namespace axisgate::api
