// Tests of a move whose state no caller follows: it costs its setting, its start and one question on the line, and
// still ends in time.
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

Setup unfollowed() {
  Setup setup = quiet();
  setup.followed = false;
  return setup;
}

int questions_of_a_move(const Setup& setup) {
  World world(setup);
  EXPECT_TRUE(world.run_until_up()) << world.replay();
  for (int i = 0; i < 8; ++i) moved(world, {{1, 1000}});  // measures the unit's lag
  const std::size_t first = world.wire().commands().size();
  moved(world, {{1, 45'100}});
  return written(world, "Q:SPC", first);
}

TEST(Unfollowed, AMoveOfASecondIsAskedForAtItsEndOnly) {
  EXPECT_EQ(questions_of_a_move(unfollowed()), 1);
  EXPECT_GE(questions_of_a_move(quiet()), 8) << "who follows it sees it move";
}

TEST(Unfollowed, ALostAxisNumberDelaysTheOutcomeLittle) {
  World world(unfollowed());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script([](LineKind kind, const std::string&) -> Scripted {
    return {.drop = kind == LineKind::notice, .delay = {}, .instead = {}};
  });
  move_by(world, {{1, 20'000}});
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) == 20'000; }, seconds(5))) << world.replay();
  ASSERT_TRUE(world.run_until([&] { return !world.outcomes().empty(); }, milliseconds(300))) << world.replay();
  EXPECT_EQ(world.outcomes()[0].state, MotionState::succeeded) << world.replay();
}

TEST(Unfollowed, AnErrorThatStopsItIsNoticedLongBeforeTheEnd) {
  World world(unfollowed());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 1'000'000}});
  world.run_for(milliseconds(500));
  world.device().set_error(1, simulator::AxisError::overflow, true, world.now());
  ASSERT_TRUE(world.run_until([&] { return !world.outcomes().empty(); }, seconds(2))) << world.replay();
  EXPECT_EQ(reason_of(world.outcomes()[0]), Reason::device_error) << world.replay();
}

TEST(Unfollowed, AStopIsFollowedToItsEnd) {
  World world(unfollowed());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 1'000'000}});
  world.run_for(milliseconds(500));
  const TimePoint asked = world.now();
  EXPECT_FALSE(stopped(world).problem);
  EXPECT_LT(world.now() - asked, milliseconds(800)) << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
