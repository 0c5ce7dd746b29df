#include "server/events/event_bus.h"

#include <gmock/gmock.h>

#include <thread>
#include <vector>

#include "server/events/newest.h"

namespace axisgate::server::event_bus_test {
namespace {

using ::testing::ElementsAre;

// Keeps the tasks it receives until the test calls run().
class HeldTasks {
 public:
  Executor executor() {
    return [this](std::function<void()> task) { tasks_.push_back(std::move(task)); };
  }
  std::size_t run() {
    std::vector<std::function<void()>> due;
    due.swap(tasks_);
    for (const auto& task : due) task();
    return due.size();
  }

 private:
  std::vector<std::function<void()>> tasks_;
};

std::vector<std::uint64_t> revisions(const EventBus::Reading& reading) {
  std::vector<std::uint64_t> found;
  for (const auto& fact : reading.facts) found.push_back(fact->revision);
  return found;
}

void publish(EventBus& bus, int count) {
  for (int i = 0; i < count; ++i) bus.publish("stage", stage::CompletionSeen{1, 7}, {});
}

TEST(EventBus, RevisionsCountFromOneOverAllDevices) {
  HeldTasks tasks;
  EventBus bus(tasks.executor());
  EXPECT_EQ(bus.newest_revision(), 0u);
  EXPECT_EQ(bus.publish("a", stage::CompletionSeen{1, 7}, WallTime(std::chrono::seconds(3))), 1u);
  EXPECT_EQ(bus.publish("b", stage::LinkChanged{stage::LinkState::up, "why"}, {}), 2u);
  const EventBus::Reading reading = bus.read(1, 10);
  EXPECT_THAT(revisions(reading), ElementsAre(1, 2));
  EXPECT_EQ(reading.next, 3u);
  EXPECT_FALSE(reading.compacted);
  EXPECT_EQ(reading.facts[0]->device, "a");
  EXPECT_EQ(reading.facts[0]->time, WallTime(std::chrono::seconds(3)));
  EXPECT_EQ(std::get<stage::CompletionSeen>(reading.facts[0]->fact).motion, 7u);
  EXPECT_EQ(reading.facts[1]->device, "b");
  EXPECT_EQ(std::get<stage::LinkChanged>(reading.facts[1]->fact).why, "why");
}

TEST(EventBus, ReadsInPortionsWithoutALoss) {
  HeldTasks tasks;
  EventBus bus(tasks.executor());
  publish(bus, 5);
  EventBus::Reading reading = bus.read(0, 2);
  EXPECT_THAT(revisions(reading), ElementsAre(1, 2));
  reading = bus.read(reading.next, 2);
  EXPECT_THAT(revisions(reading), ElementsAre(3, 4));
  reading = bus.read(reading.next, 2);
  EXPECT_THAT(revisions(reading), ElementsAre(5));
  reading = bus.read(reading.next, 2);
  EXPECT_THAT(revisions(reading), ElementsAre());
  EXPECT_EQ(reading.next, 6u);
  publish(bus, 1);
  EXPECT_THAT(revisions(bus.read(reading.next, 2)), ElementsAre(6));
}

TEST(EventBus, AReaderThatFellBehindIsToldWhereToResume) {
  HeldTasks tasks;
  EventBus bus(tasks.executor(), {}, {}, {}, 3);
  publish(bus, 5);
  EventBus::Reading reading = bus.read(2, 10);
  EXPECT_TRUE(reading.compacted);
  EXPECT_EQ(reading.next, 3u);
  EXPECT_TRUE(reading.facts.empty());
  reading = bus.read(reading.next, 10);
  EXPECT_FALSE(reading.compacted);
  EXPECT_THAT(revisions(reading), ElementsAre(3, 4, 5));
  EXPECT_THAT(revisions(bus.read(0, 10)), ElementsAre(3, 4, 5));
}

TEST(EventBus, ARevisionOfAnotherRunIsCompacted) {
  HeldTasks tasks;
  EventBus bus(tasks.executor());
  publish(bus, 2);
  EXPECT_FALSE(bus.read(3, 10).compacted);
  EXPECT_TRUE(bus.read(4, 10).compacted);
  EXPECT_EQ(bus.read(4, 10).next, 1u);
}

TEST(EventBus, ManyFactsCostOneWakeUp) {
  HeldTasks tasks;
  EventBus bus(tasks.executor());
  int woken = 0;
  const auto subscription = bus.subscribe([&] { ++woken; });
  publish(bus, 100);
  EXPECT_EQ(woken, 0) << "publishing must not run a reader";
  EXPECT_EQ(tasks.run(), 1u);
  EXPECT_EQ(woken, 1);
  publish(bus, 1);
  tasks.run();
  EXPECT_EQ(woken, 2);
}

TEST(EventBus, NoWakeUpComesAfterTheSubscriptionIsGone) {
  HeldTasks tasks;
  EventBus bus(tasks.executor());
  int woken = 0;
  auto subscription = bus.subscribe([&] { ++woken; });
  publish(bus, 1);
  subscription.reset();
  tasks.run();
  EXPECT_EQ(woken, 0);
}

TEST(EventBus, AReaderMayLeaveFromWithinItsWakeUp) {
  HeldTasks tasks;
  EventBus bus(tasks.executor());
  int woken = 0;
  std::unique_ptr<WakeUps::Subscription> subscription;
  subscription = bus.subscribe([&] {
    ++woken;
    subscription.reset();
  });
  publish(bus, 1);
  tasks.run();
  publish(bus, 1);
  tasks.run();
  EXPECT_EQ(woken, 1);
}

TEST(EventBus, WritersOnSeveralThreadsLeaveNoGap) {
  EventBus bus([](std::function<void()>) {});
  std::vector<std::thread> writers;
  for (int i = 0; i < 4; ++i) writers.emplace_back([&] { publish(bus, 500); });
  for (std::thread& writer : writers) writer.join();
  const EventBus::Reading reading = bus.read(1, 5000);
  ASSERT_EQ(reading.facts.size(), 2000u);
  for (std::size_t i = 0; i < reading.facts.size(); ++i) EXPECT_EQ(reading.facts[i]->revision, i + 1);
}

FactPointer fact_of_before(std::uint64_t revision, Fact fact = stage::CompletionSeen{1, 7},
                           std::string run = "before") {
  return std::make_shared<const FactRecord>(FactRecord{revision, "stage", {}, std::move(fact), {}, std::move(run)});
}

Fact motion(stage::MotionId id, stage::MotionState state) {
  stage::Motion changed;
  changed.id = id;
  changed.state = state;
  return stage::MotionChanged{changed};
}

// The previous run published 1 to 3, but 3 was not written; this run begins with 102.
class EventBusAfterRestart : public ::testing::Test {
 protected:
  HeldTasks tasks_;
  EventBus bus_{tasks_.executor(), "now", {{fact_of_before(1), fact_of_before(2)}, 102}};
};

TEST_F(EventBusAfterRestart, RevisionsContinue) {
  EXPECT_EQ(bus_.newest_revision(), 101u);
  publish(bus_, 2);
  const EventBus::Reading reading = bus_.read(0, 10);
  EXPECT_THAT(revisions(reading), ElementsAre(1, 2, 102, 103));
  EXPECT_EQ(reading.facts[1]->run, "before");
  EXPECT_EQ(reading.facts[2]->run, "now");
  EXPECT_EQ(reading.next, 104u);
}

TEST_F(EventBusAfterRestart, AReaderResumesOverTheGap) {
  publish(bus_, 2);
  EXPECT_THAT(revisions(bus_.read(3, 1)), ElementsAre(102));
  EXPECT_THAT(revisions(bus_.read(4, 10)), ElementsAre(102, 103)) << "3 was received and not written";
  EXPECT_TRUE(bus_.read(105, 10).compacted);
}

TEST_F(EventBusAfterRestart, RunAndRevisionBelongTogether) {
  publish(bus_, 2);
  EXPECT_TRUE(bus_.resumes("before", 1));
  EXPECT_TRUE(bus_.resumes("before", 3));
  EXPECT_TRUE(bus_.resumes("before", 4)) << "3 was received and not written";
  EXPECT_TRUE(bus_.resumes("now", 102)) << "as the revision's own run";
  EXPECT_TRUE(bus_.resumes("now", 104)) << "after the newest";
  EXPECT_FALSE(bus_.resumes("before", 103));
  EXPECT_FALSE(bus_.resumes("now", 2));
  EXPECT_FALSE(bus_.resumes("between", 3)) << "a run that was not kept";
}

TEST_F(EventBusAfterRestart, WhatIsKeptOfBothRunsIsBounded) {
  EventBus bus(tasks_.executor(), "now", {{fact_of_before(1), fact_of_before(2)}, 3}, {}, 3);
  publish(bus, 2);
  EXPECT_THAT(revisions(bus.read(0, 10)), ElementsAre(2, 3, 4));
  EXPECT_TRUE(bus.read(1, 10).compacted);
}

TEST(EventBus, EachFactIsPassedOnWithTheOldestThatIsKept) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> passed;
  EventBus bus([](std::function<void()>) {}, "now", {{fact_of_before(5)}, 6},
               [&](const FactPointer& fact, std::uint64_t oldest) { passed.emplace_back(fact->revision, oldest); }, 2);
  publish(bus, 3);
  EXPECT_THAT(passed, ElementsAre(std::pair(6, 5), std::pair(7, 6), std::pair(8, 7)));
}

TEST(EventBus, TimesAreInTheMicrosecondsOfTheFile) {
  EventBus bus([](std::function<void()>) {});
  bus.publish("stage", stage::CompletionSeen{}, WallTime(std::chrono::nanoseconds(1'999)));
  EXPECT_EQ(bus.read(0, 1).facts[0]->time, WallTime(std::chrono::microseconds(1)));
}

TEST(EventBus, TheNewestOfAMotionIsFoundAsLongAsItIsKept) {
  using stage::MotionState;
  EventBus bus([](std::function<void()>) {}, "now", {{fact_of_before(1, motion(7, MotionState::running))}, 2}, {}, 3);
  EXPECT_EQ(bus.find_motion("stage", 7)->revision, 1u);
  EXPECT_EQ(bus.find_motion("other", 7), nullptr);
  ASSERT_EQ(bus.open_motions().size(), 1u);
  bus.publish("stage", motion(7, MotionState::unknown), {});
  EXPECT_EQ(bus.find_motion("stage", 7)->revision, 2u);
  EXPECT_TRUE(bus.open_motions().empty());
  publish(bus, 2);
  EXPECT_EQ(bus.find_motion("stage", 7)->revision, 2u) << "its older fact is gone, this one is not";
  publish(bus, 1);
  EXPECT_EQ(bus.find_motion("stage", 7), nullptr);
}

TEST(Newest, OnlyTheNewestIsKept) {
  HeldTasks tasks;
  Newest<stage::State> newest(tasks.executor());
  EXPECT_EQ(newest.get().version, 0u);
  int woken = 0;
  const auto subscription = newest.subscribe([&] { ++woken; });
  stage::State state;
  state.axis(1).position_pulses = 1;
  newest.publish(state);
  state.axis(1).position_pulses = 2;
  newest.publish(state);
  tasks.run();
  EXPECT_EQ(woken, 1);
  EXPECT_EQ(newest.get().version, 2u);
  EXPECT_EQ(newest.get().value->axis(1).position_pulses, 2);
}

}  // namespace
}  // namespace axisgate::server::event_bus_test
