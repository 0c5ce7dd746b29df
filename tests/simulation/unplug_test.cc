// Hazard 31 at every moment: a line that is lost while an axis moves results in MOVING_UNKNOWN, never in idle.
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

void expect_moving_unknown(World& world, Duration offset) {
  EXPECT_EQ(world.controller().state().link, LinkState::down);
  EXPECT_TRUE(world.controller().state().moving_unknown || !world.device().busy(1))
      << "unplugged " << offset.count() << " ns after the request\n"
      << world.replay();
}

// Unplugs the cable `offset` after `start`. Reports whether the device moved at that time.
bool unplugged_in_motion(World& world, const std::function<void(World&)>& start, Duration offset) {
  EXPECT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 100}});  // the first move reads the registers
  start(world);
  world.run_for(offset);
  const bool moved = world.device().busy(1);
  world.wire().cut(world.now(), milliseconds(100));
  expect_moving_unknown(world, offset);
  return moved;
}

class HazardH31 : public testing::Test {
 protected:
  // Unplugs at moments from the request on, through the acknowledgement of the start, into the motion.
  void sweep(const std::function<void(World&)>& start) {
    int in_motion = 0;
    for (Duration offset{}; offset < milliseconds(100) && !HasFailure(); offset += microseconds(300)) {
      World world(quiet());
      in_motion += unplugged_in_motion(world, start, offset) ? 1 : 0;
    }
    EXPECT_GT(in_motion, 10);
  }
};

TEST_F(HazardH31, AMove) {
  sweep([](World& world) { move_by(world, {{1, 5000}}); });
}

TEST_F(HazardH31, AnOriginReturn) {
  sweep([](World& world) {
    world.controller().home({AxisSet::of(1), world.context("tester")}, world.now(), [](Result<Motion>) {});
  });
}

TEST_F(HazardH31, ATransaction) {
  sweep([](World& world) {
    world.controller().execute({{"M:1+P5000", "G:1"}, world.context("tester")}, world.now(),
                               [](const ExecuteEvent&) {});
  });
}

TEST_F(HazardH31, APath) {
  sweep([](World& world) {
    PathRequest path;
    path.context = world.context("tester");
    for (int i = 0; i < 3; ++i) path.segments.push_back({{{1, pulses(5000), {}}}, true, {}, {}});
    world.controller().run_path(path, world.now(), [](Result<Motion>) {});
  });
}

// The earlier motion has its outcome, UNKNOWN, but its axis still moves.
TEST_F(HazardH31, AgainBeforeTheMotionOfBeforeHasEnded) {
  World world(quiet());
  EXPECT_TRUE(unplugged_in_motion(
      world,
      [](World& w) {
        move_by(w, {{1, 200'000}});
      },
      milliseconds(100)));
  world.run_for(milliseconds(900));
  EXPECT_EQ(world.controller().state().link, LinkState::connecting);
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::unknown);
  EXPECT_TRUE(world.device().busy(1));
  world.wire().cut(world.now(), milliseconds(100));
  expect_moving_unknown(world, {});
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_FALSE(world.device().busy(1));
  EXPECT_FALSE(world.controller().state().moving_unknown);
}

// The gateway did not start the motion, but saw the axis move.
TEST_F(HazardH31, AMotionOfSomebodyElse) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  world.wire().cut(world.now(), milliseconds(100));
  for (const char* line : {"M:1+P200000\r\n", "G:1\r\n"}) world.device().receive(line, world.now());
  ASSERT_TRUE(world.run_until([&] { return world.controller().state().axis(1).busy.value_or(false); }, seconds(5)));
  world.wire().cut(world.now(), milliseconds(100));
  expect_moving_unknown(world, {});
}

}  // namespace
}  // namespace axisgate::simulation
