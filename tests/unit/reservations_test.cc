#include "device/shrc203/reservations.h"

#include <gtest/gtest.h>

namespace axisgate::shrc203 {
namespace {

using std::chrono::milliseconds;

TimePoint at(int ms) { return TimePoint(milliseconds(ms)); }

constexpr MotionId kPath = 7, kOther = 8;

TEST(Reservations, WhatEndsInTimeMayBegin) {
  Reservations reservations;
  EXPECT_TRUE(reservations.allow(0, milliseconds(1000), at(0)));
  reservations.keep(kPath, at(100));
  EXPECT_TRUE(reservations.allow(0, milliseconds(20), at(80)));
  EXPECT_FALSE(reservations.allow(0, milliseconds(20), at(81)));
  EXPECT_FALSE(reservations.allow(kOther, milliseconds(1), at(100)));
}

TEST(Reservations, APathsOwnIsNotInItsWay) {
  Reservations reservations;
  reservations.keep(kPath, at(100));
  EXPECT_TRUE(reservations.allow(kPath, milliseconds(20), at(99)));
  reservations.keep(kOther, at(110));
  EXPECT_FALSE(reservations.allow(kPath, milliseconds(20), at(99))) << "but in another's";
}

TEST(Reservations, OneThatNobodyUsesExpires) {
  Reservations reservations;
  reservations.keep(kPath, at(100));
  EXPECT_EQ(reservations.next_expiry(at(0)), at(100) + Reservations::kLate);
  EXPECT_FALSE(reservations.allow(0, milliseconds(1), at(100) + Reservations::kLate - Duration(1)));
  EXPECT_TRUE(reservations.allow(0, milliseconds(1), at(100) + Reservations::kLate));
  EXPECT_EQ(reservations.next_expiry(at(100) + Reservations::kLate), std::nullopt);
}

TEST(Reservations, APathHasOneAndGivesItBack) {
  Reservations reservations;
  reservations.keep(kPath, at(100));
  reservations.keep(kPath, at(200));
  EXPECT_TRUE(reservations.allow(0, milliseconds(20), at(99)));
  reservations.release(kPath);
  EXPECT_TRUE(reservations.allow(0, milliseconds(20), at(199)));
  EXPECT_TRUE(reservations.empty());
}

}  // namespace
}  // namespace axisgate::shrc203
