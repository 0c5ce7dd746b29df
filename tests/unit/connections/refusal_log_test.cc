// Log lines of many refusals.
#include "server/events/refusal_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/api/log.h"

namespace axisgate::server::refusal_log_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class RefusalLogTest : public ::testing::Test {
 protected:
  void note(const std::string& source, int times) {
    for (int i = 0; i < times; ++i) refusals_->note(source, source + " was refused");
  }
  // Lets the 10 s of all open windows pass.
  void pass() {
    for (const auto& task : std::exchange(tasks_, {})) task();
  }
  int lines(const std::string& text) const {
    int count = 0;
    const std::string all = log_.text();
    for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++count;
    return count;
  }

  api::Log log_;
  std::vector<std::function<void()>> tasks_;
  std::vector<Duration> waits_;
  std::optional<RefusalLog> refusals_{[this](Duration wait, std::function<void()> task) {
    waits_.push_back(wait);
    tasks_.push_back(std::move(task));
  }};
};

TEST_F(RefusalLogTest, TheFirstFiveAndThenHowManyMore) {
  note("uid 7", 12);
  EXPECT_EQ(lines("uid 7 was refused\n"), 5);
  EXPECT_EQ(lines("left out"), 0);
  ASSERT_THAT(tasks_, SizeIs(1));
  EXPECT_EQ(waits_[0], std::chrono::seconds(10));
  pass();
  EXPECT_EQ(lines("left out 7 more refusals of uid 7 in the last 10 s\n"), 1);
  note("uid 7", 6);
  EXPECT_EQ(lines("uid 7 was refused\n"), 10);
  pass();
  EXPECT_EQ(lines("left out 1 more refusals of uid 7"), 1);
}

TEST_F(RefusalLogTest, FewAreAllSaid) {
  note("uid 7", 5);
  pass();
  EXPECT_EQ(lines("uid 7 was refused\n"), 5);
  EXPECT_EQ(lines("left out"), 0);
}

TEST_F(RefusalLogTest, OneSourceDoesNotHideAnother) {
  note("10.0.0.1", 1000);
  note("10.0.0.2", 2);
  EXPECT_EQ(lines("10.0.0.2 was refused\n"), 2);
}

TEST_F(RefusalLogTest, ManySourcesShareLinesAndTakeNoMemory) {
  for (int i = 0; i < 10'000; ++i) note("address " + std::to_string(i), 1);
  EXPECT_EQ(lines(" was refused\n"), static_cast<int>(RefusalLog::kSources) + 5);
  EXPECT_THAT(tasks_, SizeIs(RefusalLog::kSources + 1));
  note("address 3", 1);
  EXPECT_EQ(lines("address 3 was refused\n"), 2) << "a source that is known keeps its lines";
  pass();
  EXPECT_EQ(lines("left out 9739 more refusals of other sources in the last 10 s\n"), 1);
  note("address 9999", 1);
  EXPECT_EQ(lines("address 9999 was refused\n"), 1) << "there is room again";
}

TEST_F(RefusalLogTest, WhatIsUnsaidAtTheEndIsSaidThen) {
  note("uid 7", 6);
  refusals_.reset();
  EXPECT_THAT(log_.text(), HasSubstr("left out 1 more refusals of uid 7"));
  pass();  // runs the timer of the destroyed object
  EXPECT_EQ(lines("left out"), 1);
}

}  // namespace
}  // namespace axisgate::server::refusal_log_test
