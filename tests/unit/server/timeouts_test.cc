// Many tasks on one timer.
#include "server/events/timeouts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "device/link/clock.h"

namespace axisgate::server::timeouts_test {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

class TimeoutsTest : public testing::Test {
 protected:
  auto note(char what) {
    return [this, what] { called_ += what; };
  }
  void run_until_called(std::size_t count) {
    const TimePoint limit = monotonic_now() + std::chrono::seconds(20);
    while (called_.size() < count && monotonic_now() < limit) io_.run_one_for(milliseconds(10));
  }

  boost::asio::io_context io_;
  std::string called_;
  Timeouts timeouts_{io_};
};

TEST_F(TimeoutsTest, RunInTheOrderOfTheirTimes) {
  timeouts_.after(hours(1), note('x'));
  timeouts_.after(milliseconds(3), note('c'));
  timeouts_.after(milliseconds(1), note('a'));
  timeouts_.after(milliseconds(2), note('b'));
  run_until_called(3);
  EXPECT_EQ(called_, "abc");
}

TEST_F(TimeoutsTest, WhatIsDroppedIsNotCalledAndTheOthersAre) {
  auto dropped = timeouts_.unless_dropped(milliseconds(1), note('x'));
  const auto kept = timeouts_.unless_dropped(milliseconds(2), note('a'));
  dropped.reset();
  run_until_called(1);
  EXPECT_EQ(called_, "a");
}

TEST_F(TimeoutsTest, ATaskMayDropItselfAndAskForAnother) {
  std::unique_ptr<Timeout> own;
  own = timeouts_.unless_dropped(milliseconds(1), [&] {
    called_ += 'a';
    own.reset();
    timeouts_.after(milliseconds(1), note('b'));
  });
  run_until_called(2);
  EXPECT_EQ(called_, "ab");
}

// A task that is dropped in time leaves no handler that would have to run.
TEST_F(TimeoutsTest, TenThousandThatAreDroppedShareOneTimer) {
  for (int i = 0; i < 10'000; ++i) (void)timeouts_.unless_dropped(hours(1), note('x')).reset();
  EXPECT_EQ(io_.poll(), 0u);
}

TEST_F(TimeoutsTest, NothingIsCalledAfterItsEnd) {
  std::optional<Timeouts> ending(std::in_place, io_);
  ending->after(milliseconds(0), note('x'));
  ending.reset();
  io_.run_for(milliseconds(5));
  EXPECT_EQ(called_, "");
}

}  // namespace
}  // namespace axisgate::server::timeouts_test
