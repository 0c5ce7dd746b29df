#include "device/shrc203/state/motion_gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace axisgate::shrc203::motion_gate_test {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

const AxisSet kLower = AxisSet::of(1), kUpper = AxisSet::of(2);
constexpr TimePoint kLater = TimePoint{} + milliseconds(1000);

class MotionGateTest : public testing::Test {
 protected:
  void enter(MotionGate& gate, MotionId id, AxisSet axes, std::string caller = "a", TimePoint not_after = kLater) {
    const auto wait = [](OneShot<Result<void>> answer, MotionId number, std::vector<std::string>& news) -> Task<void> {
      const auto entered = co_await answer;
      news.push_back(std::to_string(number) + (entered ? " in" : " " + std::string(name(entered.error().reason))));
    };
    executor_.spawn(wait(gate.enter(id, axes, caller, not_after), id, heard_));
  }
  std::vector<std::string> heard() {
    executor_.run();
    return std::exchange(heard_, {});
  }
  Executor executor_;
  std::vector<std::string> heard_;
};

TEST_F(MotionGateTest, OneMotionAtATimeWhereOneBusyAxisRefusesTheOthers) {
  MotionGate gate(executor_, Scope::controller);
  enter(gate, 1, kLower);
  enter(gate, 2, kUpper);
  EXPECT_THAT(heard(), ElementsAre("1 in"));
  EXPECT_EQ(gate.waiting(), 1u);
  gate.leave(1);
  EXPECT_THAT(heard(), ElementsAre("2 in"));
}

TEST_F(MotionGateTest, DifferentAxesTogetherWhereEachIsBusyForItself) {
  MotionGate gate(executor_, Scope::axis);
  enter(gate, 1, kLower);
  EXPECT_FALSE(gate.others_inside(1));
  enter(gate, 2, kUpper);
  enter(gate, 3, kLower);
  EXPECT_THAT(heard(), ElementsAre("1 in", "2 in"));
  EXPECT_TRUE(gate.others_inside(1));
  gate.leave(2);
  EXPECT_THAT(heard(), ElementsAre());
  gate.leave(1);
  EXPECT_THAT(heard(), ElementsAre("3 in"));
}

TEST_F(MotionGateTest, AMotionHasItsAxesToItself) {
  MotionGate each(executor_, Scope::axis), whole(executor_, Scope::controller);
  enter(each, 1, kLower);
  enter(each, 2, kUpper);
  enter(whole, 1, kLower);
  EXPECT_EQ(each.axes_of(1), kLower);
  EXPECT_EQ(whole.axes_of(1), AxisSet::all());
  EXPECT_EQ(whole.axes_of(2), AxisSet());
}

TEST_F(MotionGateTest, CallersTakeTurns) {
  MotionGate gate(executor_, Scope::controller);
  enter(gate, 1, kLower, "busy");
  enter(gate, 2, kLower, "busy");
  enter(gate, 3, kLower, "busy");
  enter(gate, 4, kLower, "rare");
  gate.leave(1);
  gate.leave(2);
  EXPECT_THAT(heard(), ElementsAre("1 in", "2 in", "4 in"));
}

TEST_F(MotionGateTest, WithdrawTurnsTheChosenAway) {
  MotionGate gate(executor_, Scope::controller);
  enter(gate, 1, kLower);
  enter(gate, 2, kLower);
  enter(gate, 3, kLower);
  gate.withdraw([](MotionId id) { return id == 2; }, Problem{Reason::stopped, "by somebody", {}, {}, {}, {}});
  EXPECT_THAT(heard(), ElementsAre("1 in", "2 STOPPED"));
  gate.leave(1);
  EXPECT_THAT(heard(), ElementsAre("3 in"));
}

TEST_F(MotionGateTest, NobodyWaitsLongerThanAllowed) {
  MotionGate gate(executor_, Scope::controller);
  enter(gate, 1, kLower);
  enter(gate, 2, kLower, "a", TimePoint{} + milliseconds(100));
  EXPECT_GT(*gate.next_deadline(), TimePoint{} + milliseconds(100));
  gate.expire(TimePoint{} + milliseconds(100));
  EXPECT_THAT(heard(), ElementsAre("1 in"));
  gate.expire(*gate.next_deadline());
  EXPECT_THAT(heard(), ElementsAre("2 DEADLINE_PASSED"));
  EXPECT_EQ(gate.next_deadline(), std::nullopt);
}

TEST_F(MotionGateTest, IsBounded) {
  MotionGate gate(executor_, Scope::controller);
  enter(gate, 1, kLower);
  for (MotionId id = 2; id < 2 + 1024; ++id) enter(gate, id, kLower);
  EXPECT_THAT(heard(), ElementsAre("1 in"));
  enter(gate, 5000, kLower);
  EXPECT_THAT(heard(), ElementsAre("5000 QUEUE_FULL"));
}

}  // namespace
}  // namespace axisgate::shrc203::motion_gate_test
