// Tests of jogs of a rotor, and of the ways to end them.
#include <gtest/gtest.h>

#include "tests/double/rig.h"

namespace axisgate::rotor {
namespace {

using std::chrono::milliseconds;

TEST(RotorJog, AJogEndsWhenItIsNotRenewed) {
  Rig rig;
  const MotionId id = rig.jog(-1);
  for (int i = 0; i < 10; ++i) {
    rig.run(milliseconds(200));
    ASSERT_TRUE(rig.controller.renew_jog(id, {}, rig.now));
  }
  EXPECT_EQ(rig.motion(id).state, MotionState::running);
  rig.run(StageController::kJogSilence + milliseconds(50));
  EXPECT_EQ(rig.motion(id).state, MotionState::stopped);
  EXPECT_EQ(rig.motion(id).problem->reason, Reason::stopped);
  EXPECT_FALSE(rig.rotor.busy());
  EXPECT_NEAR(static_cast<double>(rig.rotor.position()), -2500, 20);
  EXPECT_EQ(rig.controller.renew_jog(id, {}, rig.now).error().reason, Reason::not_found);
  EXPECT_EQ(rig.written(Opcode::stop), 1);
}

TEST(RotorJog, AJogThatItsCallerEndsHasSucceeded) {
  Rig rig;
  const MotionId id = rig.jog(1);
  rig.run(milliseconds(100));
  ASSERT_TRUE(rig.controller.renew_jog(id, {{1, 1, pulses(5000)}}, rig.now));
  rig.run(milliseconds(200));
  rig.controller.end_jog(id, {}, rig.now);
  EXPECT_EQ(rig.outcome(id), MotionState::succeeded);
  EXPECT_NEAR(static_cast<double>(rig.rotor.position()), 1100, 50);
}

TEST(RotorJog, AJogStopsBeforeItsTravelLimit) {
  Profile profile;
  profile.axes[0].travel_maximum = pulses(3000);
  Rig rig(false, profile);
  const MotionId id = rig.jog(1);
  for (int i = 0; i < 20; ++i) {
    rig.run(milliseconds(200));
    (void)rig.controller.renew_jog(id, {}, rig.now);
  }
  EXPECT_EQ(rig.motion(id).state, MotionState::stopped);
  EXPECT_EQ(rig.motion(id).problem->reason, Reason::outside_travel);
  EXPECT_GT(rig.rotor.position(), 2000);
  EXPECT_LE(rig.rotor.position(), 3000);
}

TEST(RotorJog, AJogEndsWithItsLease) {
  Rig rig;
  const MotionId id = rig.jog(1, {.who = "anna", .lease = 5});
  rig.run(milliseconds(200));
  rig.porter.refusing = true;
  rig.run(milliseconds(150));
  EXPECT_EQ(rig.motion(id).state, MotionState::stopped);
  EXPECT_EQ(rig.motion(id).problem->reason, Reason::lease_held);
  EXPECT_FALSE(rig.rotor.busy());
}

TEST(RotorJog, AJogThatWaitsInVainStopsNobodyElse) {
  Rig rig;
  const MotionId running = rig.move(20'000), jog = rig.jog(1);
  EXPECT_EQ(rig.outcome(running), MotionState::succeeded);
  EXPECT_EQ(rig.motion(jog).state, MotionState::stopped);
  EXPECT_EQ(rig.written(Opcode::jog), 0);
  EXPECT_EQ(rig.written(Opcode::stop), 0);
}

TEST(RotorJog, AJogThatRanOnIsStoppedWhenTheLineIsBack) {
  Rig rig;
  (void)rig.jog(1);
  rig.run(milliseconds(100));
  rig.controller.link_down(rig.now, "unplugged");
  EXPECT_TRUE(rig.rotor.busy());
  rig.run(milliseconds(300));
  EXPECT_FALSE(rig.rotor.busy());
}

}  // namespace
}  // namespace axisgate::rotor
