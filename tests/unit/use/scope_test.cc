// Tests of scopes: axes of a stage, and a whole device.
#include "device/use/scope.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/stage/axes.h"

namespace axisgate::use {
namespace {

using stage::AxisSet;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Scope kOne = AxisSet::of(1), kThree = AxisSet::of(3);

TEST(Scope, OfAxesIsASet) {
  EXPECT_TRUE((kOne | kThree).contains(kOne));
  EXPECT_FALSE(kOne.contains(kOne | kThree));
  EXPECT_TRUE((kOne | kThree).touches(kThree));
  EXPECT_FALSE(kOne.touches(kThree));
  EXPECT_EQ((kOne | kThree) - kOne, kThree);
  EXPECT_EQ((kOne | kThree) & kOne, kOne);
  EXPECT_THAT((kOne | kThree).list(), ElementsAre(1, 3));
  EXPECT_EQ(AxisSet::in(kOne | kThree), AxisSet::of(1) | AxisSet::of(3));
}

TEST(Scope, OfAWholeDeviceHasNoAxes) {
  constexpr Scope kWhole = Scope::whole_device();
  EXPECT_TRUE(kWhole.is_whole_device());
  EXPECT_FALSE(Scope(AxisSet::first(3)).is_whole_device());
  EXPECT_FALSE(kWhole.empty());
  EXPECT_TRUE(kWhole.touches(kWhole));
  EXPECT_TRUE((kWhole - kWhole).empty());
  EXPECT_THAT(kWhole.list(), IsEmpty());
  EXPECT_TRUE(AxisSet::in(kWhole).empty());
}

TEST(Scope, IsNamedForPeople) {
  EXPECT_EQ(to_string(Scope::whole_device()), "the whole device");
  EXPECT_EQ(to_string(kOne), "axis 1");
  EXPECT_EQ(to_string(kOne | kThree), "axes 1 and 3");
  EXPECT_EQ(to_string(Scope(AxisSet::first(3))), "axes 1, 2 and 3");
  EXPECT_EQ(to_string(Scope()), "no axis");
}

}  // namespace
}  // namespace axisgate::use
