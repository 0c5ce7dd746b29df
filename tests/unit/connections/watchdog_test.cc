// Signs of life while threads answer, and while one does not.
#include "server/watchdog.h"

#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <functional>
#include <future>
#include <optional>
#include <utility>
#include <vector>

namespace axisgate::server::watchdog_test {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(500);

class WatchdogTest : public testing::Test {
 protected:
  void watch() {
    const auto thread = [this](std::size_t number) {
      return [this, number](std::function<void()> answer) { asked_[number].push_back(std::move(answer)); };
    };
    watchdog_.emplace(
        std::vector<Watchdog::Thread>{{"one", thread(0)}, {"two", thread(1)}}, kPeriod,
        [this](Duration wait, std::function<void()> task) {
          EXPECT_EQ(wait, kPeriod);
          later_.push_back(std::move(task));
        },
        [this] { ++alive_; });
  }
  void answer(std::size_t thread) {
    for (const auto& one : std::exchange(asked_[thread], {})) one();
  }
  void pass_a_period() {
    for (const auto& task : std::exchange(later_, {})) task();
  }

  std::vector<std::function<void()>> asked_[2];
  std::vector<std::function<void()>> later_;
  int alive_ = 0;
  std::optional<Watchdog> watchdog_;
};

TEST_F(WatchdogTest, ASignForEachPeriodInWhichAllAnswered) {
  watch();
  for (int period = 1; period <= 3; ++period) {
    answer(0);
    answer(1);
    EXPECT_EQ(alive_, period - 1);
    pass_a_period();
    EXPECT_EQ(alive_, period);
  }
}

TEST_F(WatchdogTest, OneThatIsSilentIsEnough) {
  watch();
  answer(0);
  for (int period = 0; period < 10; ++period) pass_a_period();
  EXPECT_EQ(alive_, 0);
  EXPECT_EQ(asked_[1].size(), 1u) << "it is not asked again";
  EXPECT_TRUE(asked_[0].empty());
  answer(1);
  pass_a_period();
  EXPECT_EQ(alive_, 1);
  EXPECT_EQ(asked_[0].size(), 1u);
}

TEST_F(WatchdogTest, AnAnswerAtOnceCounts) {
  watchdog_.emplace(
      std::vector<Watchdog::Thread>{{"one", [](const std::function<void()>& answer) { answer(); }}}, kPeriod,
      [this](Duration, std::function<void()> task) { later_.push_back(std::move(task)); }, [this] { ++alive_; });
  pass_a_period();
  pass_a_period();
  EXPECT_EQ(alive_, 2);
}

// The objects through which the threads are asked are destroyed after the watchdog.
TEST_F(WatchdogTest, ItsEndWaitsWhileThreadsAreAsked) {
  std::promise<void> asking, ended;
  std::future<void> end = ended.get_future();
  bool ended_while_asking = true;
  int asked = 0;
  watchdog_.emplace(
      std::vector<Watchdog::Thread>{{"one",
                                     [&](const std::function<void()>& answer) {
                                       answer();
                                       if (++asked == 1) return;
                                       asking.set_value();
                                       // Only a failing test sees the watchdog end here; otherwise the wait lasts the
                                       // whole limit.
                                       const auto seen = end.wait_for(std::chrono::milliseconds(100));
                                       ended_while_asking = seen == std::future_status::ready;
                                     }}},
      kPeriod, [this](Duration, std::function<void()> task) { later_.push_back(std::move(task)); },
      [this] { ++alive_; });
  const auto round = std::async(std::launch::async, [this] { pass_a_period(); });
  asking.get_future().wait();
  watchdog_.reset();
  ended.set_value();
  round.wait();
  EXPECT_FALSE(ended_while_asking);
}

TEST_F(WatchdogTest, NoSignAfterItsEnd) {
  watch();
  answer(0);
  const auto late = std::exchange(asked_[1], {});
  watchdog_.reset();
  for (const auto& one : late) one();
  pass_a_period();
  EXPECT_EQ(alive_, 0);
}

}  // namespace
}  // namespace axisgate::server::watchdog_test
