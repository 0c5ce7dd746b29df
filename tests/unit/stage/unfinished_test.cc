#include "device/stage/unfinished.h"

#include <gmock/gmock.h>

namespace axisgate::stage::unfinished_test {
namespace {

using testing::ElementsAre;
using testing::Field;

Stop stop_of(StopId id, AxisSet axes) { return {.id = id, .axes = axes}; }

TEST(Within, LeavesOutAxesThatTheDeviceDoesNotHave) {
  Inheritance left;
  left.unfinished = Unfinished{.serial_number = "1",
                               .moving = AxisSet::of(2) | AxisSet::of(4),
                               .jogged = AxisSet::of(4),
                               .motions = "motion 3",
                               .last_lines = {"G:2"}};
  left.open_stops = {stop_of(1, AxisSet::of(1) | AxisSet::of(8)), stop_of(2, AxisSet::of(4))};
  left.last_stop = 2;
  const Inheritance kept = within(AxisSet::first(3), left);
  ASSERT_TRUE(kept.unfinished);
  EXPECT_EQ(kept.unfinished->moving, AxisSet::of(2));
  EXPECT_EQ(kept.unfinished->jogged, AxisSet());
  EXPECT_THAT(kept.open_stops, ElementsAre(Field(&Stop::axes, AxisSet::of(1))));
  EXPECT_EQ(kept.last_stop, 2u);
}

TEST(Within, LeavesNothingOfAnUnknownAxis) {
  Inheritance left;
  left.unfinished =
      Unfinished{.serial_number = "1", .moving = AxisSet::of(5), .jogged = {}, .motions = "motion 3", .last_lines = {}};
  EXPECT_FALSE(within(AxisSet::first(3), left).unfinished);
}

}  // namespace
}  // namespace axisgate::stage::unfinished_test
