#include "device/shrc203/planning/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/shrc203/planning/path_plan.h"

namespace axisgate::shrc203::plan_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Quantity millimeters(std::int64_t digits, int decimals = 0) { return {{digits, decimals}, Unit::millimeters}; }

// Three axes with 10 nm a pulse and S 1000 F 50000 R 100, at 0; axis 1 travels from -1 mm to 1 mm at 0.2 mm/s at most.
class PlanTest : public testing::Test {
 protected:
  PlanTest() {
    for (const int number : kAllAxes.list()) {
      auto& axis = state.axis(number);
      axis.controllable = true;
      axis.scale = Scale{{10, 0}, false};
      axis.position_pulses = 0;
      axis.minimum_speed = 1000;
      axis.maximum_speed = 50000;
      axis.acceleration_ms = 100;
    }
    profile.axes[0].name = "sample";
    profile.axes[0].unit = Unit::millimeters;
    profile.axes[0].travel_minimum = millimeters(-1);
    profile.axes[0].travel_maximum = millimeters(1);
    profile.axes[0].maximum_speed = millimeters(2, 1);
  }

  Result<MovePlan> move(std::vector<AxisMove> moves, bool relative) const {
    return plan_move(moves, relative, positions_of(state), Envelope(profile, state, "tester", "operator"));
  }
  Reason refused(std::vector<AxisMove> moves, bool relative = false) const {
    const auto plan = move(std::move(moves), relative);
    return plan ? Reason::unspecified : plan.error().reason;
  }
  Result<PathPlan> path(std::vector<Segment> segments) const {
    return plan_path({std::move(segments), {}}, positions_of(state), Envelope(profile, state, "tester", "operator"));
  }
  Reason path_refused(std::vector<Segment> segments) const {
    const auto plan = path(std::move(segments));
    return plan ? Reason::unspecified : plan.error().reason;
  }

  Profile profile;
  State state;
};

TEST_F(PlanTest, MovesInAxisOrderAndExactPulses) {
  const auto plan = move({{3, pulses(-7), {}}, {2, millimeters(15, 1), {}}}, false);
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->axes.size(), 2u);
  EXPECT_EQ(plan->axes[0].axis, 2);
  EXPECT_EQ(plan->axes[0].amount, 150000);
  EXPECT_EQ(plan->axes[1].amount, -7);
  EXPECT_EQ(plan->set(), AxisSet::of(2) | AxisSet::of(3));
  EXPECT_FALSE(plan->axes[0].speed);
}

TEST_F(PlanTest, BeforeTheDeviceHasToldItsAxesNoneIsSaidToBeMissing) {
  state = {};
  state.link_problem = "no such device";
  const auto plan = move({{3, pulses(1), {}}}, false);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().reason, Reason::link_down);
  EXPECT_THAT(plan.error().message, testing::EndsWith("no such device"));
}

TEST_F(PlanTest, ARelativeMoveEndsWhereItsStartAndWayTell) {
  state.axes[1].position_pulses = 300;
  const auto plan = move({{2, pulses(-1000), {}}}, true);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->axes[0].amount, -1000);
  EXPECT_EQ(plan->axes[0].target, -700);
}

TEST_F(PlanTest, TravelLimitsAreInclusive) {
  EXPECT_TRUE(move({{1, pulses(100000), {}}}, false));
  EXPECT_TRUE(move({{1, pulses(-100000), {}}}, false));
  EXPECT_EQ(refused({{1, pulses(100001), {}}}), Reason::outside_travel);
  EXPECT_EQ(refused({{1, pulses(-100001), {}}}), Reason::outside_travel);
  state.axes[0].position_pulses = 60000;
  EXPECT_EQ(refused({{1, pulses(40001), {}}}, true), Reason::outside_travel);
  EXPECT_TRUE(move({{1, pulses(40000), {}}}, true));
}

TEST_F(PlanTest, ARefusalNamesTheAxisTheTargetAndTheLimit) {
  const auto plan = move({{1, millimeters(25, 1), {}}}, false);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().axis, 1);
  EXPECT_THAT(plan.error().message,
              testing::AllOf(testing::HasSubstr("sample"), testing::HasSubstr("2.5mm"), testing::HasSubstr("1mm")));
}

TEST_F(PlanTest, WhereTheStartIsUnknownARelativeWayIsNotChecked) {
  state.axes[0].position_pulses.reset();
  const auto plan = move({{1, pulses(500000), {}}}, true);
  ASSERT_TRUE(plan);
  EXPECT_FALSE(plan->axes[0].target);
  EXPECT_EQ(refused({{1, pulses(500000), {}}}), Reason::outside_travel);
}

TEST_F(PlanTest, AxesThatCannotBeMoved) {
  EXPECT_EQ(refused({}), Reason::invalid_request);
  EXPECT_EQ(refused({{0, pulses(1), {}}}), Reason::unknown_axis);
  EXPECT_EQ(refused({{4, pulses(1), {}}}), Reason::unknown_axis);
  EXPECT_EQ(refused({{2, pulses(1), {}}, {2, pulses(1), {}}}), Reason::invalid_request);
  state.axes[2].controllable = false;
  EXPECT_EQ(refused({{3, pulses(1), {}}}), Reason::unknown_axis);
  state.axes[1].scale.reset();
  EXPECT_EQ(refused({{2, pulses(1), {}}}), Reason::position_unknown);
}

TEST_F(PlanTest, WhatPulsesCannotSay) {
  EXPECT_EQ(refused({{2, {{15, 0}, Unit::nanometers}, {}}}), Reason::not_representable);
  EXPECT_EQ(refused({{2, {{1, 0}, Unit::degrees}, {}}}), Reason::unknown_unit);
  EXPECT_EQ(refused({{2, pulses(1'000'000'000), {}}}), Reason::out_of_range);
  state.axes[1].position_pulses = 999'999'999;
  EXPECT_EQ(refused({{2, pulses(1), {}}}, true), Reason::out_of_range);
}

TEST_F(PlanTest, SpeedsAreCheckedAndCapped) {
  const auto with = [](std::int64_t s, std::int64_t f, int r) {
    return std::vector<AxisMove>{{1, pulses(10), SpeedProfile{pulses(s), pulses(f), r}}};
  };
  const auto plan = move(with(100, 20000, 50), false);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->axes[0].speed->minimum, 100);
  EXPECT_EQ(plan->axes[0].speed->maximum, 20000);
  EXPECT_EQ(plan->axes[0].speed->acceleration_ms, 50);
  EXPECT_EQ(refused(with(100, 20001, 50)), Reason::too_fast);
  EXPECT_EQ(refused(with(0, 100, 50)), Reason::out_of_range);
  EXPECT_EQ(refused(with(200, 100, 50)), Reason::out_of_range);
  EXPECT_EQ(refused(with(100, 200, 0)), Reason::out_of_range);
  EXPECT_EQ(refused(with(100, 200, 1001)), Reason::out_of_range);
}

// A speed that another program left in the controller must not exceed the configured maximum.
TEST_F(PlanTest, TheDevicesOwnSpeedIsCappedToo) {
  const auto plan = move({{1, pulses(10), {}}}, false);
  ASSERT_TRUE(plan);
  ASSERT_TRUE(plan->axes[0].speed);
  EXPECT_EQ(plan->axes[0].speed->maximum, 20000);
  state.axes[0].maximum_speed = 20000;
  EXPECT_FALSE(move({{1, pulses(10), {}}}, false)->axes[0].speed);
}

Segment line(std::int64_t x, std::int64_t y) {
  return {{{2, pulses(x), {}}, {3, pulses(y), {}}}, true, pulses(5000), {}};
}

TEST_F(PlanTest, APathEndsWhereItsSegmentsLead) {
  const auto plan = path({line(3000, 4000), line(-1000, 0)});
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->segments.size(), 2u);
  EXPECT_EQ(plan->segments[0].end[1], 3000);
  EXPECT_EQ(plan->segments[1].end[1], 2000);
  EXPECT_EQ(plan->segments[1].end[2], 4000);
  EXPECT_EQ(plan->axes, AxisSet::of(2) | AxisSet::of(3));
}

// Manual 83): a straight line runs at S of its lower axis: 5,000 pulses at 5,000 pulses/s.
TEST_F(PlanTest, ALineTakesItsLengthAtItsPathSpeed) {
  const auto plan = path({line(3000, 4000)});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->segments[0].move.axes[0].speed->minimum, 5000);
  EXPECT_FALSE(plan->segments[0].move.axes[1].speed);
  EXPECT_EQ(plan->segments[0].shortest, seconds(1));
  EXPECT_EQ(plan->segments[0].longest, seconds(1));
}

// Average speed 13,000 pulses/s for 0.2 s at each end, and 44,800 pulses at 25,000 pulses/s in between.
TEST_F(PlanTest, OneAxisSpeedsUpAndSlowsDown) {
  Segment segment{{{2, pulses(50000), {}}}, false, pulses(25000), 200};
  const auto plan = path({segment});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->segments[0].shortest, milliseconds(400 + 1792));
  EXPECT_EQ(plan->segments[0].longest, seconds(2) + milliseconds(400));
  EXPECT_EQ(plan->segments[0].move.axes[0].speed->maximum, 25000);
  EXPECT_EQ(plan->segments[0].move.axes[0].speed->acceleration_ms, 200);
}

// Acceleration from 1,000 pulses/s by 490,000 pulses/s in a second: 15,700 pulses/s after 30 ms, at half of the 501
// pulses.
TEST_F(PlanTest, AShortWayNeverReachesF) {
  const auto plan = path({{{{2, pulses(501), {}}}, true, {}, {}}});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->segments[0].shortest, milliseconds(60));
}

TEST_F(PlanTest, OneAxisWithoutARamp) {
  state.axes[1].minimum_speed = state.axes[1].maximum_speed = 5000;
  const auto plan = path({{{{2, pulses(500), {}}}, true, {}, {}}});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->segments[0].shortest, milliseconds(100));
}

TEST_F(PlanTest, PathsThatCannotBe) {
  EXPECT_EQ(path_refused({}), Reason::invalid_request);
  EXPECT_EQ(path_refused({line(1, 1), line(0, 0)}), Reason::invalid_request) << "it moves nothing";
  EXPECT_EQ(path_refused({line(1, 1), {{{2, pulses(1), {}}}, true, {}, {}}}), Reason::invalid_request) << "other axes";
  EXPECT_EQ(path_refused({{{{1, pulses(90000), {}}}, true, {}, {}}, {{{1, pulses(20000), {}}}, true, {}, {}}}),
            Reason::outside_travel);
  state.axes[2].scale = Scale{{20, 0}, false};
  EXPECT_EQ(path_refused({line(1, 1)}), Reason::invalid_request) << "pulses of different length";
  state.axes[1].position_pulses.reset();
  EXPECT_EQ(path_refused({{{{2, pulses(1), {}}}, true, {}, {}}}), Reason::position_unknown);
}

TEST_F(PlanTest, APathsRefusalNamesTheSegment) {
  const auto plan = path({line(1, 1), line(2, 2), line(0, 0)});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, testing::StartsWith("segment 3: "));
}

// A segment that requests only an acceleration time runs at the caller's maximum speed, not at the controller's speed.
TEST_F(PlanTest, ASegmentWithoutASpeedIsNoFasterThanAllowed) {
  Segment segment;
  segment.moves.push_back({1, pulses(1000), {}});
  segment.acceleration_ms = 50;
  const auto plan = path({segment});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->segments[0].move.axes[0].speed->maximum, 20000);  // 0.2 mm/s at 10 nm a pulse
}

}  // namespace
}  // namespace axisgate::shrc203::plan_test
