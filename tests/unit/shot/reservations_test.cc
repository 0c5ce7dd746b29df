#include "device/shot/line/reservations.h"

#include <gtest/gtest.h>

#include "device/shrc203/limits.h"

namespace axisgate::shot::reservations_test {
namespace {

using std::chrono::milliseconds;

TimePoint instant(int ms) { return TimePoint(milliseconds(ms)); }

constexpr MotionId kPath = 7, kOther = 8;

TEST(Reservations, WhatEndsInTimeMayBegin) {
  Reservations reservations;
  EXPECT_TRUE(reservations.allow(0, milliseconds(1000), instant(0)));
  reservations.keep(kPath, instant(100));
  EXPECT_TRUE(reservations.allow(0, milliseconds(20), instant(80)));
  EXPECT_FALSE(reservations.allow(0, milliseconds(20), instant(81)));
  EXPECT_FALSE(reservations.allow(kOther, milliseconds(1), instant(100)));
}

TEST(Reservations, APathsOwnIsNotInItsWay) {
  Reservations reservations;
  reservations.keep(kPath, instant(100));
  EXPECT_TRUE(reservations.allow(kPath, milliseconds(20), instant(99)));
  reservations.keep(kOther, instant(110));
  EXPECT_FALSE(reservations.allow(kPath, milliseconds(20), instant(99))) << "but in another's";
}

TEST(Reservations, OneThatNobodyUsesExpires) {
  Reservations reservations;
  reservations.keep(kPath, instant(100));
  EXPECT_EQ(reservations.next_expiry(instant(0)), instant(100) + kRefillReservedAfterDue);
  EXPECT_FALSE(reservations.allow(0, milliseconds(1), instant(100) + kRefillReservedAfterDue - Duration(1)));
  EXPECT_TRUE(reservations.allow(0, milliseconds(1), instant(100) + kRefillReservedAfterDue));
  EXPECT_EQ(reservations.next_expiry(instant(100) + kRefillReservedAfterDue), std::nullopt);
}

TEST(Reservations, APathHasOneAndGivesItBack) {
  Reservations reservations;
  reservations.keep(kPath, instant(100));
  reservations.keep(kPath, instant(200));
  EXPECT_TRUE(reservations.allow(0, milliseconds(20), instant(99)));
  reservations.release(kPath);
  EXPECT_TRUE(reservations.allow(0, milliseconds(20), instant(199)));
  EXPECT_TRUE(reservations.empty());
}

}  // namespace
}  // namespace axisgate::shot::reservations_test
