#include "device/core/lane_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace axisgate::lane_queue_test {
namespace {

using Queue = LaneQueue<int>;
using testing::ElementsAre;

const auto kAny = [](int) { return true; };

std::vector<int> take_all(Queue& queue) {
  std::vector<int> taken;
  while (auto work = queue.take(kAny)) taken.push_back(*work);
  return taken;
}

TEST(LaneQueue, TheFirstLaneGoesFirst) {
  Queue queue;
  queue.push(Lane::poll, "a", 5);
  queue.push(Lane::question, "a", 4);
  queue.push(Lane::motion, "a", 3);
  queue.push(Lane::path_refill, "a", 2);
  queue.push(Lane::stop, "a", 1);
  EXPECT_THAT(take_all(queue), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(queue.take(kAny), std::nullopt);
}

TEST(LaneQueue, ACallersOwnWorkKeepsItsOrder) {
  Queue queue;
  for (int work = 1; work <= 4; ++work) queue.push(Lane::motion, "a", work);
  EXPECT_THAT(take_all(queue), ElementsAre(1, 2, 3, 4));
}

TEST(LaneQueue, CallersTakeTurns) {
  Queue queue;
  for (int work = 1; work <= 4; ++work) queue.push(Lane::motion, "busy", work);
  queue.push(Lane::motion, "rare", 100);
  queue.push(Lane::motion, "rare", 101);
  EXPECT_THAT(take_all(queue), ElementsAre(1, 100, 2, 101, 3, 4));
}

TEST(LaneQueue, AtMostEverySecondIsAStopWhileSomethingElseWaits) {
  Queue queue;
  for (int work = 1; work <= 3; ++work) queue.push(Lane::stop, "s", work);
  queue.push(Lane::poll, "p", 50);
  EXPECT_THAT(take_all(queue), ElementsAre(1, 50, 2, 3));
}

TEST(LaneQueue, StopsDoNotWaitForWorkThatIsNotAdmissible) {
  Queue queue;
  queue.push(Lane::stop, "s", 1);
  queue.push(Lane::stop, "s", 2);
  queue.push(Lane::motion, "m", 50);
  const auto small = [](int work) { return work < 10; };
  EXPECT_EQ(queue.take(small), 1);
  EXPECT_EQ(queue.take(small), 2);
  EXPECT_EQ(queue.take(small), std::nullopt);
  EXPECT_EQ(queue.size(Lane::motion), 1u);
}

TEST(LaneQueue, ALaneIsPassedOverAFewTimesOnly) {
  Queue queue;
  queue.push(Lane::poll, "p", 1000);
  int before = 0;
  for (int work = 0; work < 100; ++work) {
    queue.push(Lane::motion, "m", work);
    if (queue.take(kAny) == 1000) break;
    ++before;
  }
  EXPECT_EQ(before, Queue::kPassesMax);
}

TEST(LaneQueue, IsBoundedByLane) {
  Queue queue;
  for (std::size_t i = 0; i < Queue::kLaneMax; ++i) ASSERT_TRUE(queue.push(Lane::question, "q", 1));
  EXPECT_FALSE(queue.push(Lane::question, "q", 1));
  EXPECT_TRUE(queue.push(Lane::stop, "s", 1)) << "a full lane held a stop up";
  ASSERT_TRUE(queue.take(kAny));
  ASSERT_TRUE(queue.take(kAny));
  EXPECT_TRUE(queue.push(Lane::question, "q", 1));
}

TEST(LaneQueue, OneCallersShareOfALaneIsBounded) {
  Queue queue;
  for (std::size_t i = 0; i < Queue::kShareMax; ++i) ASSERT_TRUE(queue.push(Lane::motion, "m", 1, Queue::kShareMax));
  const auto refused = queue.push(Lane::motion, "m", 1, Queue::kShareMax);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::queue_full);
  EXPECT_EQ(refused.error().message, "m has 256 requests waiting in the motion lane, as many as one caller may have");
  EXPECT_EQ(refused.error().hint, "wait for some of them, and try again in 1 s");
  EXPECT_TRUE(queue.push(Lane::question, "m", 1, Queue::kShareMax));
  EXPECT_TRUE(queue.push(Lane::motion, "n", 1, Queue::kShareMax));
  EXPECT_TRUE(queue.push(Lane::motion, "m", 1)) << "what has no share";
}

TEST(LaneQueue, VisitsWorkInTheOrderOfTurns) {
  Queue queue;
  for (int work = 1; work <= 3; ++work) queue.push(Lane::motion, "busy", work);
  queue.push(Lane::motion, "rare", 100);
  queue.take(kAny);
  std::vector<int> seen;
  queue.for_each_in_turn(Lane::motion, [&](int work) { seen.push_back(work); });
  EXPECT_THAT(seen, ElementsAre(100, 2, 3));
  EXPECT_EQ(queue.take(kAny), 100);
}

TEST(LaneQueue, DrainHandsOverTheChosenAndKeepsTheOthersOrder) {
  Queue queue;
  for (int work = 1; work <= 5; ++work) queue.push(Lane::motion, "m", work);
  std::vector<int> drained;
  queue.drain([](int work) { return work % 2 == 1; }, [&](int work) { drained.push_back(work); });
  EXPECT_THAT(drained, ElementsAre(1, 3, 5));
  EXPECT_THAT(take_all(queue), ElementsAre(2, 4));
}

TEST(LaneQueue, DrainHandsOverInTheOrderInWhichItCame) {
  Queue queue;
  for (const int work : {1, 3, 5}) queue.push(Lane::motion, "b", work);
  for (const int work : {2, 4}) queue.push(Lane::motion, "a", work);
  queue.push(Lane::stop, "c", 6);
  std::vector<int> drained;
  queue.drain([](int work) { return work != 3; }, [&](int work) { drained.push_back(work); });
  EXPECT_THAT(drained, ElementsAre(6, 1, 5, 2, 4));
  EXPECT_THAT(take_all(queue), ElementsAre(3));
}

TEST(LaneQueue, WhatIsNotAdmissibleKeepsItsPlaceAndItsCallersTurn) {
  Queue queue;
  queue.push(Lane::motion, "a", 10);
  queue.push(Lane::motion, "a", 1);
  queue.push(Lane::motion, "b", 20);
  queue.push(Lane::motion, "b", 2);
  const auto small = [](int work) { return work < 10; };
  EXPECT_TRUE(queue.any_of(small));
  EXPECT_EQ(queue.take(small), 1);
  EXPECT_EQ(queue.take(small), 2);
  EXPECT_FALSE(queue.any_of(small));
  queue.push(Lane::motion, "b", 21);
  queue.push(Lane::motion, "c", 30);
  EXPECT_THAT(take_all(queue), ElementsAre(30, 10, 20, 21));
}

TEST(LaneQueue, TurnsAreForgottenWhenNothingWaits) {
  Queue queue;
  queue.push(Lane::motion, "a", 1);
  queue.take(kAny);
  queue.push(Lane::motion, "a", 2);
  queue.push(Lane::motion, "b", 3);
  EXPECT_THAT(take_all(queue), ElementsAre(2, 3));
}

TEST(LaneQueue, WorkMayComeInWhileItIsDrained) {
  Queue queue;
  queue.push(Lane::motion, "m", 1);
  queue.drain(kAny, [&](int) { queue.push(Lane::motion, "m", 2); });
  EXPECT_THAT(take_all(queue), ElementsAre(2));
}

}  // namespace
}  // namespace axisgate::lane_queue_test
