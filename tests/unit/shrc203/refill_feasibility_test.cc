#include "device/shrc203/planning/refill_feasibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisgate::shrc203::refill_feasibility_test {
namespace {

using std::chrono::milliseconds;

SegmentPlan segment(Duration lasts, std::vector<AxisPlan> axes) {
  SegmentPlan plan;
  plan.move = {true, std::move(axes)};
  plan.shortest = plan.longest = lasts;
  return plan;
}
SegmentPlan to_and_fro(Duration lasts) { return segment(lasts, {{1, 100, {}, {}}}); }

// 10,000 baud: a millisecond a byte; answers arrive without delay.
class FeedingTest : public testing::Test {
 protected:
  FeedingTest() { timing.answered(0, 0, {}); }

  PathPlan path(std::vector<Duration> times) const {
    PathPlan plan{AxisSet::of(1), {}, {}};
    for (const Duration time : times) plan.segments.push_back(to_and_fro(time));
    return plan;
  }

  LineTiming timing{10'000, 3};
};

// "1", "MP:1+P100" and OK_D with CR LF each: 3 + 11 + 6 ms, and 5 ms for the host.
constexpr auto kShortest = milliseconds(25);

TEST_F(FeedingTest, TheTimeIsThatOfTheLinesThatMustPass) {
  const PathPlan plan = path({kShortest, kShortest});
  EXPECT_EQ(segment_setter(plan, 2).line, "MP:1+P100");
  EXPECT_EQ(shortest_feasible(plan, 1, timing), kShortest);
  timing = LineTiming(10'000, 3);
  for (const int time : {3, 3, 90}) timing.answered(0, 0, milliseconds(4 + time));
  EXPECT_EQ(shortest_feasible(plan, 1, timing), kShortest + milliseconds(3)) << "one slow answer is not what is usual";
}

TEST_F(FeedingTest, AStraightLineIsEndedByBothNumbers) {
  PathPlan plan{AxisSet::of(1) | AxisSet::of(2), {}, {}};
  const auto line = segment(kShortest, {{1, 100, {}, SpeedSetting{20000, 50000, 100}}, {2, -7, {}, {}}});
  plan.segments = {line, line};
  EXPECT_EQ(segment_setter(plan, 2).line, "KP:A+P100-P7,S20000F50000R100");
  EXPECT_EQ(shortest_feasible(plan, 1, timing), milliseconds(2 * 3 + 31 + 6 + 5));
}

TEST_F(FeedingTest, WhatIsShorterIsRefused) {
  EXPECT_TRUE(check_refill_feasibility(path({kShortest, kShortest, kShortest}), timing));
  const auto refused = check_refill_feasibility(path({kShortest, kShortest - milliseconds(1), kShortest}), timing);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::too_fast);
  EXPECT_EQ(refused.error().message,
            "segment 2 takes 24.0 ms, in which a line of 10000 baud cannot set the next one: the shortest feasible "
            "segment time is 25 ms");
  EXPECT_THAT(refused.error().hint, testing::StartsWith("let every segment but the last take 25 ms or more: "));
}

TEST_F(FeedingTest, WhatIsFollowedByARestMayBeShort) {
  PathPlan plan = path({milliseconds(1), kShortest});
  EXPECT_FALSE(check_refill_feasibility(plan, timing));
  plan.segments[1].rest = milliseconds(1);
  EXPECT_TRUE(check_refill_feasibility(plan, timing)) << "the next one is set while nothing runs";
}

TEST_F(FeedingTest, TheLastSegmentMayBeShort) {
  EXPECT_TRUE(check_refill_feasibility(path({milliseconds(1)}), timing)) << "nothing is set while it runs";
  EXPECT_TRUE(check_refill_feasibility(path({kShortest, milliseconds(1)}), timing));
}

}  // namespace
}  // namespace axisgate::shrc203::refill_feasibility_test
