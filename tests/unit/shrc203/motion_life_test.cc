// Every phase of a motion with every event, and every interruption, typed from the tables in
// device/shrc203/README.md.
#include "device/shrc203/state/motion_life.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/unit/core/transition_table.h"

namespace axisgate::shrc203::motion_life_test {
namespace {

using stage::MotionState;
using testing_tables::Table;

TEST(MotionLifeTable, EachPairLeadsWhereThePageSays) {
  const Table table = {
      {"queued", {"preparing", "-", "-", "ended", "-", "-"}},
      {"preparing", {"-", "setting", "resting", "ended", "restoring", "-"}},
      {"resting", {"-", "running", "-", "ended", "restoring", "-"}},
      {"setting", {"-", "setting", "running", "ended", "restoring", "-"}},
      {"running", {"-", "running", "-", "ended", "restoring", "-"}},
      {"restoring", {"-", "-", "-", "-", "-", "ended"}},
      {"ended", {"-", "-", "-", "-", "-", "-"}},
  };
  const int illegal = testing_tables::illegal_pairs<MotionPhase, MotionEvent>(
      table, kMotionPhases, {"entered", "written", "started", "finished", "finished_to_restore", "left"},
      [](MotionPhase phase, MotionEvent event) { return next(phase, event); });
  EXPECT_EQ(illegal, 25);
}

TEST(InterruptionTable, NothingFromOutsideIsIllegal) {
  const Table table = {
      {"none", {"stop", "line_lost"}},
      {"stop", {"stop", "stop_and_line_lost"}},
      {"line_lost", {"stop_and_line_lost", "line_lost"}},
      {"stop_and_line_lost", {"stop_and_line_lost", "stop_and_line_lost"}},
  };
  const int illegal = testing_tables::illegal_pairs<Interruption, InterruptionEvent>(
      table, kInterruptions, {"stop_asked", "line_lost"},
      [](Interruption from, InterruptionEvent event) { return std::optional(next(from, event)); });
  EXPECT_EQ(illegal, 0);
}

TEST(MotionLife, AnEventThatCannotBeLeavesThePhase) {
  MotionLife life;
  EXPECT_FALSE(life.happened(MotionEvent::started));
  EXPECT_EQ(life.phase(), MotionPhase::queued);
}

TEST(MotionLife, WhatCallersSeeOnItsWay) {
  MotionLife life;
  EXPECT_EQ(life.shown(), MotionState::queued);
  ASSERT_TRUE(life.happened(MotionEvent::entered));
  EXPECT_EQ(life.shown(), MotionState::queued);
  ASSERT_TRUE(life.happened(MotionEvent::written));
  EXPECT_EQ(life.shown(), MotionState::queued);
  ASSERT_TRUE(life.happened(MotionEvent::started));
  EXPECT_EQ(life.shown(), MotionState::running);
  life.stop("bert");
  EXPECT_EQ(life.shown(), MotionState::stopping);
  EXPECT_EQ(life.stopped_by(), "bert");
}

TEST(MotionLife, AStopBeforeTheStartIsSeenAtTheStart) {
  MotionLife life;
  life.stop("bert");
  EXPECT_EQ(life.shown(), MotionState::queued);
  ASSERT_TRUE(life.happened(MotionEvent::entered));
  ASSERT_TRUE(life.happened(MotionEvent::written));
  ASSERT_TRUE(life.happened(MotionEvent::started));
  EXPECT_EQ(life.shown(), MotionState::stopping);
}

// A path that pauses before its first segment is shown as running, but has written nothing to the registers.
TEST(MotionLife, OneThatRestsFirstHasWrittenNothing) {
  MotionLife life;
  ASSERT_TRUE(life.happened(MotionEvent::entered));
  ASSERT_TRUE(life.happened(MotionEvent::started));
  EXPECT_EQ(life.shown(), MotionState::running);
  EXPECT_FALSE(life.has_written());
  ASSERT_TRUE(life.happened(MotionEvent::written));
  EXPECT_TRUE(life.has_written());
  EXPECT_EQ(life.shown(), MotionState::running);
}

TEST(MotionLife, ItHasItsTurnUntilEverythingIsRestored) {
  MotionLife life;
  EXPECT_FALSE(life.has_turn());
  ASSERT_TRUE(life.happened(MotionEvent::entered));
  EXPECT_TRUE(life.has_turn());
  ASSERT_TRUE(life.happened(MotionEvent::finished_to_restore));
  EXPECT_TRUE(life.has_turn());
  EXPECT_TRUE(life.has_outcome());
  ASSERT_TRUE(life.happened(MotionEvent::left));
  EXPECT_FALSE(life.has_turn());
}

TEST(MotionLife, ALostLineAndAStopAreBothKept) {
  MotionLife life;
  life.lose_line("unplugged");
  EXPECT_TRUE(life.line_lost());
  EXPECT_FALSE(life.stop_asked());
  life.stop("bert");
  EXPECT_TRUE(life.line_lost());
  EXPECT_TRUE(life.stop_asked());
  EXPECT_EQ(life.line_problem(), "unplugged");
}

}  // namespace
}  // namespace axisgate::shrc203::motion_life_test
