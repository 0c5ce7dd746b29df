// Share of a path's speed that each axis has on a curve.
#include "device/shrc203/planning/curve_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace axisgate::shrc203::curve_plan_test {
namespace {

// Half a circle with a radius of 100 pulses while the third axis moves 50: the speed applies along the helix.
TEST(ShareOfSpeed, IsAllInThePlaneAndThePitchBesideIt) {
  const Arc arc{.radius = 100, .heading = 0, .sweep = std::numbers::pi, .rise = -50};
  EXPECT_EQ(share_of_speed(arc, false), 1);
  EXPECT_DOUBLE_EQ(share_of_speed(arc, true), 50 / std::hypot(100 * std::numbers::pi, 50));
}

}  // namespace
}  // namespace axisgate::shrc203::curve_plan_test
