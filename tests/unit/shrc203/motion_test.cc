#include "device/stage/motion.h"

#include <gtest/gtest.h>

namespace axisgate::stage::motion_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(OccupationBy, NamesAxesMotionCallerAndTheTimeLeft) {
  const TimePoint now{seconds(1000)};
  Motion motion;
  motion.id = 1312;
  motion.axes = AxisSet::of(1);
  motion.who = "unix bert";
  EXPECT_EQ(text_of(occupation_by(motion), now), "axis 1 is in motion 1312 (move by unix bert)");
  motion.due = now + milliseconds(3001);
  EXPECT_EQ(text_of(occupation_by(motion), now), "axis 1 is in motion 1312 (move by unix bert, 4 s left)");
  motion.due = now + milliseconds(1);
  EXPECT_EQ(text_of(occupation_by(motion), now), "axis 1 is in motion 1312 (move by unix bert, 1 s left)");
  motion.due = now;
  EXPECT_EQ(text_of(occupation_by(motion), now), "axis 1 is in motion 1312 (move by unix bert)");
  motion.kind = MotionKind::path;
  motion.axes.add(3);
  EXPECT_EQ(text_of(occupation_by(motion), now), "axes 1 and 3 are in motion 1312 (path by unix bert)");
  motion.kind = MotionKind::execute;
  motion.axes = {};
  EXPECT_EQ(text_of(occupation_by(motion), now), "motion 1312 (execute by unix bert) sets the controller");
}

}  // namespace
}  // namespace axisgate::stage::motion_test
