#include "device/shrc203/motion/ready_lag.h"

#include <gtest/gtest.h>

#include <chrono>

namespace axisgate::shrc203 {
namespace {

using std::chrono::milliseconds;

// Returns the number of questions to a unit that is READY `ready` after its axis number: the first when `lag` says so,
// then one every 5 ms.
int questions(ReadyLag& lag, Duration ready) {
  int asked = 0;
  for (Duration at = lag.first_question();; at += milliseconds(5)) {
    ++asked;
    if (at >= ready) {
      lag.seen_ready(at);
      return asked;
    }
    lag.seen_busy(at);
  }
}

TEST(ReadyLagTest, NothingIsWaitedForBeforeAnythingIsKnown) {
  EXPECT_EQ(ReadyLag().first_question(), Duration::zero());
}

TEST(ReadyLagTest, AUnitThatIsReadyAtItsNumberIsAskedAtOnce) {
  ReadyLag lag;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(questions(lag, Duration::zero()), 1);
  EXPECT_EQ(lag.first_question(), Duration::zero());
}

TEST(ReadyLagTest, FindsWhenAUnitIsReady) {
  ReadyLag lag;
  for (int i = 0; i < 10; ++i) questions(lag, milliseconds(13));
  EXPECT_GE(lag.first_question(), milliseconds(11));
  EXPECT_LE(lag.first_question(), milliseconds(15));
}

TEST(ReadyLagTest, SoonAsksHardlyAnybodyTwice) {
  ReadyLag lag;
  for (int i = 0; i < 10; ++i) questions(lag, milliseconds(13));
  int asked = 0;
  for (int i = 0; i < 100; ++i) asked += questions(lag, milliseconds(13));
  EXPECT_LE(asked, 102);
}

TEST(ReadyLagTest, FollowsAUnitThatBecomesSlower) {
  ReadyLag lag;
  for (int i = 0; i < 10; ++i) questions(lag, milliseconds(5));
  for (int i = 0; i < 10; ++i) questions(lag, milliseconds(40));
  EXPECT_GE(lag.first_question(), milliseconds(40));
  EXPECT_LE(lag.first_question(), milliseconds(42));
}

TEST(ReadyLagTest, FollowsAUnitThatBecomesFaster) {
  ReadyLag lag;
  for (int i = 0; i < 10; ++i) questions(lag, milliseconds(40));
  for (int i = 0; i < 600; ++i) questions(lag, milliseconds(5));
  EXPECT_LE(lag.first_question(), milliseconds(10));
}

// The delay has another cause: a number that came too early, or a stop in between.
TEST(ReadyLagTest, WhatTakesTooLongIsNotSettling) {
  ReadyLag lag;
  lag.seen_busy(milliseconds(300));
  lag.seen_ready(milliseconds(400));
  EXPECT_EQ(lag.first_question(), Duration::zero());
}

}  // namespace
}  // namespace axisgate::shrc203
