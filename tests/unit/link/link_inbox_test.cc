#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "device/link/inbox.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::link_test {
namespace {

class InboxTest : public testing::Test {
 protected:
  EventLoop loop_;
  Strand strand_ = loop_.strand();
  std::optional<Inbox> inbox_{std::in_place, strand_};
};

TEST_F(InboxTest, WhatThreadsPostRunsOnceAndInTheirOrder) {
  constexpr int kThreads = 4;
  constexpr int kTasks = 2000;
  std::vector<std::vector<int>> ran(kThreads);
  std::vector<std::thread> threads;
  for (int thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([this, &ran, thread] {
      for (int task = 0; task < kTasks; ++task) {
        inbox_->post([&ran, thread, task] { ran[static_cast<std::size_t>(thread)].push_back(task); });
      }
    });
  }
  const auto all_ran = [&] {
    std::size_t count = 0;
    for (const auto& tasks : ran) count += tasks.size();
    return count == std::size_t{kThreads} * kTasks;
  };
  EXPECT_TRUE(loop_.run_until(all_ran));
  for (std::thread& thread : threads) thread.join();
  for (const auto& tasks : ran) {
    for (int task = 0; task < kTasks; ++task) EXPECT_EQ(tasks[static_cast<std::size_t>(task)], task);
  }
}

TEST_F(InboxTest, ATaskThatPostsHasItsTaskRunToo) {
  bool ran = false;
  inbox_->post([&] { inbox_->post([&] { ran = true; }); });
  EXPECT_TRUE(loop_.run_until([&] { return ran; }));
}

TEST_F(InboxTest, TheStrandsOwnWorkHasItsTurnBetweenManyTasks) {
  std::vector<std::string> order;
  for (int task = 0; task < 1000; ++task) {
    inbox_->post([&] {
      if (order.empty()) boost::asio::post(strand_, [&] { order.emplace_back("the line"); });
      order.emplace_back("task");
    });
  }
  EXPECT_TRUE(loop_.run_until([&] { return order.size() == 1001; }));
  EXPECT_LT(std::ranges::find(order, "the line") - order.begin(), 100);
}

TEST_F(InboxTest, OnceClosedItRunsAndKeepsNothing) {
  const auto kept = std::make_shared<int>();
  bool ran = false;
  inbox_->post([&, kept] { ran = true; });
  inbox_->close();
  inbox_->post([&, kept] { ran = true; });
  loop_.run_ready();
  EXPECT_FALSE(ran);
  EXPECT_EQ(kept.use_count(), 1);
}

TEST_F(InboxTest, WhoseTaskCannotRunIsToldOnce) {
  int ran = 0, too_late = 0;
  inbox_->post([&] { ++ran; }, [&] { ++too_late; });
  inbox_->close();
  EXPECT_EQ(too_late, 1) << "of what waited";
  inbox_->post([&] { ++ran; }, [&] { ++too_late; });
  EXPECT_EQ(too_late, 2) << "of what comes later";
  loop_.run_ready();
  EXPECT_EQ(ran, 0);
}

TEST_F(InboxTest, ATaskThatRanIsNotToldToBeTooLate) {
  int ran = 0, too_late = 0;
  inbox_->post([&] { ++ran; }, [&] { ++too_late; });
  EXPECT_TRUE(loop_.run_until([&] { return ran == 1; }));
  inbox_->close();
  EXPECT_EQ(too_late, 0);
}

TEST_F(InboxTest, ATaskMayCloseIt) {
  int ran = 0;
  inbox_->post([&] {
    ++ran;
    inbox_.reset();
  });
  inbox_->post([&] { ++ran; });
  EXPECT_TRUE(loop_.run_until([&] { return ran == 1; }));
  loop_.run_ready();
  EXPECT_EQ(ran, 1);
}

}  // namespace
}  // namespace axisgate::link_test
