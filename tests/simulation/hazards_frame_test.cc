// Hazard 27: a caller sets coordinates again while another caller's program runs (manual 45) PSET:, 63) R:, 64) RC:).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

class HazardOfFrames : public testing::Test {
 protected:
  HazardOfFrames() { EXPECT_TRUE(world.run_until_up()); }

  std::uint64_t frame() { return world.controller().state().frame_epoch; }
  // Executes a line and waits for the end of the transaction.
  std::vector<std::string> execute(const std::string& line) {
    auto said = simulation::execute(world, {line});
    world.run_for(milliseconds(200));
    return said;
  }

  bool homed(int axis) { return world.controller().state().axis(axis).homed; }

  Motion go_to(std::int64_t target, std::uint64_t frame_epoch) {
    MoveRequest request = move_of(world, {{1, target}}, false);
    request.context.frame_epoch = frame_epoch;
    const auto refused = std::make_shared<Reason>(Reason::unspecified);
    const std::size_t before = world.outcomes().size();
    world.controller().move(std::move(request), world.now(), [refused](const Result<Motion>& motion) {
      if (!motion) *refused = motion.error().reason;
    });
    Motion motion;
    if (*refused == Reason::unspecified) return outcome_of(world, before + 1);
    motion.problem = Problem{*refused, {}, {}, {}, {}, {}};
    return motion;
  }

  World world{quiet()};
};

TEST_F(HazardOfFrames, H27_ATargetOfTheFrameBeforeIsRefused) {
  moved(world, {{1, 700}});
  for (const char* line : {"R:1", "RC:1", "PSET:1+P300", "r:", "PSET:W-P5-P5-P5"}) {
    const std::uint64_t before = frame();
    const int starts = written(world, "G:");
    EXPECT_EQ(execute(line), std::vector<std::string>{"OK"}) << line;
    EXPECT_EQ(frame(), before + 1) << line;
    EXPECT_EQ(reason_of(go_to(1000, before)), Reason::epoch_passed) << line;
    EXPECT_EQ(written(world, "G:"), starts) << line;
    EXPECT_EQ(go_to(1000, frame()).state, MotionState::succeeded) << line << world.replay();
    EXPECT_EQ(go_to(900, 0).state, MotionState::succeeded) << line << world.replay();
  }
}

// A target that has waited for its turn also belongs to the previous frame.
TEST_F(HazardOfFrames, H27_ATargetThatHasWaited) {
  move_by(world, {{1, 20'000}});
  world.run_for(milliseconds(50));
  bool ended = false;
  world.controller().execute({{"R:1"}, world.context("bert")}, world.now(), [&](const ExecuteEvent& event) {
    ended = ended || event.kind == ExecuteEvent::Kind::ended;
  });
  EXPECT_EQ(reason_of(go_to(1000, frame())),
            Reason::unspecified);  // reason of the first motion, which is the next to end
  ASSERT_TRUE(world.run_until([&] { return ended; }, seconds(10))) << world.replay();
  Motion last;
  ASSERT_TRUE(world.run_until(
      [&] {
        const auto motions = world.controller().motions();
        last = motions.back();
        for (const Motion& motion : motions) {
          if (motion.id > last.id) last = motion;
        }
        return is_outcome(last.state);
      },
      seconds(10)))
      << world.replay();
  EXPECT_EQ(reason_of(last), Reason::epoch_passed) << world.replay();
  EXPECT_EQ(written(world, "AP:"), 0) << world.replay();
}

// A refused line changes no frame. A line whose answer was lost may have changed it.
TEST_F(HazardOfFrames, H27_RefusedOrInDoubt) {
  const std::uint64_t before = frame();
  EXPECT_EQ(execute("C:10"), std::vector<std::string>{"OK"});
  EXPECT_EQ(execute("R:1").front(), "NG");
  EXPECT_EQ(frame(), before);
  EXPECT_EQ(execute("C:11"), std::vector<std::string>{"OK"});
  world.wire().set_script(drop_first(world, LineKind::reply, "PSET:"));
  execute("PSET:1+P300");
  world.wire().set_script({});
  EXPECT_GT(frame(), before) << world.replay();
}

// The travel limits count from the origin found by homing.
TEST_F(HazardOfFrames, H27_TheOriginIsNoLongerTheOneThatWasFound) {
  home(world, kAllAxes);
  outcome_of(world, 1);
  EXPECT_TRUE(homed(1) && homed(2));
  EXPECT_EQ(execute("R:1"), std::vector<std::string>{"OK"});
  EXPECT_FALSE(homed(1));
  EXPECT_TRUE(homed(2));
}

TEST_F(HazardOfFrames, ARelativeMoveAfterwardsStartsFromTheNewCoordinate) {
  moved(world, {{1, 700}});
  EXPECT_EQ(execute("R:1"), std::vector<std::string>{"OK"});
  moved(world, {{1, 50}});
  EXPECT_EQ(world.device().position(1), 50) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
