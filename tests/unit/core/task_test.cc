#include "device/core/task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace axisgate::task_test {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

constexpr TimePoint kStart{};

struct Log {
  std::vector<std::string> lines;
  void add(std::string line) { lines.push_back(std::move(line)); }
};

Task<int> doubled(OneShot<int> shot) {
  const int value = co_await shot;
  co_return 2 * value;
}

Task<void> add_doubled(OneShot<int> shot, Log& log) {
  log.add("begins");
  const int value = co_await doubled(shot);
  log.add(std::to_string(value));
}

TEST(Task, StartsOnlyWhenTheExecutorRuns) {
  Executor executor;
  Log log;
  OneShot<int> shot(executor);
  executor.spawn(add_doubled(shot, log));
  EXPECT_THAT(log.lines, ElementsAre());
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre("begins"));
}

TEST(Task, GoesOnWithWhatWasDeliveredAtTheNextRun) {
  Executor executor;
  Log log;
  OneShot<int> shot(executor);
  executor.spawn(add_doubled(shot, log));
  executor.run();
  shot.deliver(21);
  EXPECT_THAT(log.lines, ElementsAre("begins")) << "resumed from within the delivery";
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre("begins", "42"));
}

TEST(Task, WhatWasDeliveredBeforeIsNotWaitedFor) {
  Executor executor;
  Log log;
  OneShot<int> shot(executor);
  shot.deliver(1);
  shot.deliver(2);  // only the first delivery counts
  executor.spawn(add_doubled(shot, log));
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre("begins", "2"));
}

TEST(Task, SuspendedTasksAreDestroyedWithTheExecutor) {
  auto held = std::make_shared<int>(1);
  {
    Executor executor;
    OneShot<int> never(executor);
    const auto wait = [](OneShot<int> shot, std::shared_ptr<int> kept) -> Task<void> {
      co_await shot;
      ++*kept;
    };
    executor.spawn(wait(never, held));
    executor.run();
    EXPECT_EQ(held.use_count(), 2);
  }
  EXPECT_EQ(held.use_count(), 1);
  EXPECT_EQ(*held, 1);
}

TEST(Task, EndedTasksAreLetGo) {
  Executor executor;
  auto held = std::make_shared<int>(1);
  const auto end = [](std::shared_ptr<int>) -> Task<void> { co_return; };
  executor.spawn(end(held));
  executor.run();
  EXPECT_EQ(held.use_count(), 1);
}

Task<void> spawn_another(Executor& executor, Log& log) {
  const auto second = [](Log& to) -> Task<void> {
    to.add("second");
    co_return;
  };
  executor.spawn(second(log));
  executor.run();  // within a task, so the outer run() continues with the second task
  log.add("first");
  co_return;
}

TEST(Task, ATaskMaySpawnAnother) {
  Executor executor;
  Log log;
  executor.spawn(spawn_another(executor, log));
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre("first", "second"));
}

Task<void> wait_for(Signal& signal, TimePoint until, Log& log) {
  auto pending = signal.wait_until(until);
  const bool notified = co_await pending;
  log.add(notified ? "notified" : "late");
}

TEST(Signal, NotifiesEverybodyWhoWaits) {
  Executor executor;
  Signal signal(executor);
  Log log;
  executor.spawn(wait_for(signal, kStart + milliseconds(10), log));
  executor.spawn(wait_for(signal, kStart + milliseconds(20), log));
  executor.run();
  signal.notify();
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre("notified", "notified"));
}

TEST(Signal, TellsWhenTheDeadlineHasPassed) {
  Executor executor;
  Signal signal(executor);
  Log log;
  executor.spawn(wait_for(signal, kStart + milliseconds(10), log));
  executor.run();
  EXPECT_EQ(executor.next_deadline(), kStart + milliseconds(10));
  executor.advance(kStart + milliseconds(9));
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre());
  executor.advance(kStart + milliseconds(10));
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre("late"));
  EXPECT_EQ(executor.next_deadline(), std::nullopt);
  signal.notify();  // no waiter is left
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre("late"));
}

TEST(Signal, ANotificationBeforeTheWaitCountsForNothing) {
  Executor executor;
  Signal signal(executor);
  Log log;
  signal.notify();
  executor.spawn(wait_for(signal, kStart + milliseconds(10), log));
  executor.run();
  EXPECT_THAT(log.lines, ElementsAre());
}

}  // namespace
}  // namespace axisgate::task_test
