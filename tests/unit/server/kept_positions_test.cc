// Lines about positions that the controller stores, and its answers about them. Typed from manual 127) to 136).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/shrc203/command/saved_positions.h"

namespace axisgate::shrc203::kept_positions_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr PositionSlot kPlace{true, 3}, kCoordinates{false, 20};

TEST(KeptPositions, TheirLines) {
  const PositionLines place = position_lines(kPlace), coordinates = position_lines(kCoordinates);
  EXPECT_EQ(place.save, "PIT:SET,3");
  EXPECT_EQ(place.tell, "PIT:GET,3");
  EXPECT_EQ(place.forget, "PIT:DEL,3");
  EXPECT_EQ(coordinates.save, "PAV:SET,20");
  EXPECT_EQ(coordinates.tell, "PAV:GET,20");
  EXPECT_EQ(coordinates.forget, "PAV:DEL,20");
}

TEST(KeptPositions, WhatIsToldOfThem) {
  EXPECT_THAT(read_position(kPlace, "1000,-2000,0", AxisSet::first(3)),
              ElementsAre(Pair(1, 1000), Pair(2, -2000), Pair(3, 0)));
  const AxisSet two = AxisSet::of(1) | AxisSet::of(3);
  EXPECT_THAT(read_position(kCoordinates, "1000,-2000", two), ElementsAre(Pair(1, 1000), Pair(3, -2000)));
  EXPECT_THAT(read_position(kCoordinates, "1000,0,-2000", two), ElementsAre(Pair(1, 1000), Pair(3, -2000)));
}

TEST(KeptPositions, WhatTellsNone) {
  for (const char* answer : {"NG", "OK", "", "1,2,x", "S1F2R3"}) {
    EXPECT_THAT(read_position(kPlace, answer, AxisSet::first(3)), IsEmpty()) << answer;
  }
}

}  // namespace
}  // namespace axisgate::shrc203::kept_positions_test
