#include <gtest/gtest.h>

#include <future>

#include "device/link/line_thread.h"

namespace axisgate::link_test {
namespace {

using std::chrono::microseconds;

class WakefulnessTest : public testing::Test {
 protected:
  void exchange(microseconds reply) {
    wakefulness_.written(now_);
    now_ += reply;
    wakefulness_.replied(now_);
  }

  Wakefulness wakefulness_;
  TimePoint now_{std::chrono::seconds(1000)};
};

TEST_F(WakefulnessTest, NobodyStaysAwakeForALineThatWasNeverPrompt) {
  EXPECT_FALSE(wakefulness_.is_awake(now_));
  wakefulness_.written(now_);
  EXPECT_FALSE(wakefulness_.is_awake(now_));
  now_ += std::chrono::milliseconds(5);
  wakefulness_.replied(now_);
  EXPECT_FALSE(wakefulness_.is_awake(now_));
}

TEST_F(WakefulnessTest, APromptReplyIsFollowedByAMomentAwake) {
  exchange(microseconds(40));
  EXPECT_TRUE(wakefulness_.is_awake(now_ + microseconds(99)));
  EXPECT_FALSE(wakefulness_.is_awake(now_ + microseconds(100)));
}

TEST_F(WakefulnessTest, AndSoIsTheNextQuestion) {
  exchange(microseconds(40));
  now_ += std::chrono::seconds(1);
  EXPECT_FALSE(wakefulness_.is_awake(now_));
  wakefulness_.written(now_);
  EXPECT_TRUE(wakefulness_.is_awake(now_ + microseconds(99)));
}

// At 115200 baud a command's first two bytes alone take 174 µs.
TEST_F(WakefulnessTest, OneLateReplyEndsIt) {
  exchange(microseconds(40));
  now_ += std::chrono::seconds(1);
  exchange(microseconds(174));
  EXPECT_FALSE(wakefulness_.is_awake(now_));
  wakefulness_.written(now_);
  EXPECT_FALSE(wakefulness_.is_awake(now_));
}

// These bytes are later pieces of a reply, or an axis number.
TEST_F(WakefulnessTest, WhatComesUnaskedKeepsNobodyAwake) {
  exchange(microseconds(40));
  now_ += std::chrono::seconds(1);
  wakefulness_.replied(now_);
  EXPECT_FALSE(wakefulness_.is_awake(now_));
}

TEST(LineThreadTest, RunsWhatIsPostedUntilItIsStopped) {
  LineThread thread;
  std::promise<void> ran;
  boost::asio::post(thread.new_strand(), [&] { ran.set_value(); });
  thread.start();
  ran.get_future().wait();
  thread.stop();
  bool again = false;
  boost::asio::post(thread.new_strand(), [&] { again = true; });
  EXPECT_FALSE(again);
}

}  // namespace
}  // namespace axisgate::link_test
