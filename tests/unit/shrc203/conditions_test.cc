// Interpretation of a stage's status, and the changes of it that count. The statuses are typed from manual 5) Q:S,
// where bit 1 is the lowest.
#include "device/shrc203/state/conditions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/shot/command/status.h"

namespace axisgate::shrc203::conditions_test {
namespace {

using stage::Condition;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

TimePoint at(int second) { return TimePoint(seconds(second)); }

TEST(Conditions, AStatusInWords) {
  const auto said = [](std::uint32_t status) {
    std::vector<std::string> texts;
    for (const Condition condition : stage::listed(conditions_in({status}))) texts.push_back(stage::words(condition));
    return texts;
  };
  EXPECT_THAT(said(0x1), IsEmpty());
  EXPECT_THAT(said(0x3), IsEmpty()) << "an error in the last command is none of the stage";
  EXPECT_THAT(said(0x0), ElementsAre("error without a name"));
  EXPECT_THAT(said(0x2), IsEmpty()) << "a refused command may hide that the axis is normal";
  EXPECT_THAT(said(0x4), ElementsAre("scale error (S1)"));
  EXPECT_THAT(said(0x20), ElementsAre("emergency stop"));
  EXPECT_THAT(said(0x80001), ElementsAre("CW limit sensor on"));
  EXPECT_THAT(said(0x100080), ElementsAre("limit error (S5)", "CCW limit sensor on"));
  EXPECT_THAT(said(0x1040001), ElementsAre("homing", "ORG sensor on"));
  EXPECT_THAT(said(0x1FFFFFF).size(), 23u) << "every bit but normal and command error";
}

TEST(Conditions, ANameIsReadBack) {
  for (const Condition condition : stage::reported_conditions()) {
    EXPECT_EQ(stage::condition_named(name(condition)), condition);
  }
  EXPECT_EQ(stage::condition_named("no such"), Condition{});
  EXPECT_EQ(name(Condition{77}), "condition_77");
}

TEST(Conditions, WhatHasChangedInWords) {
  const auto axes = AxisSet::of(1) | AxisSet::of(3);
  EXPECT_EQ(stage::words(Condition::emergency_stop, axes, true, ""), "axes 1 and 3: emergency stop");
  EXPECT_EQ(stage::words(Condition::emergency_stop, axes, false, ""), "axes 1 and 3: emergency stop ended");
  EXPECT_EQ(stage::words(Condition::motor_off, AxisSet::of(2), false, ""), "axis 2: motor on");
  EXPECT_EQ(stage::words(Condition::mode, {}, true, "MANUAL"), "controller in MANUAL mode");
  EXPECT_EQ(stage::words(Condition::mode, {}, false, "HOST"), "controller in HOST mode again");
  EXPECT_EQ(stage::words(Condition{77}, AxisSet::of(2), true, ""), "axis 2: condition_77 on");
}

class Readings : public testing::Test {
 protected:
  Conditions::Changes read(std::uint32_t first, std::uint32_t second, int second_of_reading) {
    return conditions_.status_read({{1, conditions_in({first})}, {2, conditions_in({second})}}, at(second_of_reading));
  }
  Conditions conditions_;
};

TEST_F(Readings, TwoThatAgreeAreAChangeFromTheFirstOfThem) {
  EXPECT_THAT(read(0x1, 0x1, 10), IsEmpty());
  EXPECT_THAT(read(0x1, 0x1, 11), IsEmpty());
  EXPECT_THAT(read(0x20, 0x20, 12), IsEmpty());
  EXPECT_TRUE(conditions_.status_doubtful());
  const auto begun = read(0x20, 0x20, 13);
  EXPECT_FALSE(conditions_.status_doubtful());
  ASSERT_EQ(begun.size(), 1u);
  EXPECT_EQ(begun[0].condition, Condition::emergency_stop);
  EXPECT_EQ(begun[0].axes, AxisSet::of(1) | AxisSet::of(2));
  EXPECT_TRUE(begun[0].begun);
  EXPECT_EQ(begun[0].before, at(11));
  EXPECT_EQ(begun[0].seen, at(12));
  EXPECT_THAT(read(0x20, 0x1, 14), IsEmpty());
  const auto ended = read(0x20, 0x1, 15);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].axes, AxisSet::of(2));
  EXPECT_FALSE(ended[0].begun);
  EXPECT_EQ(ended[0].before, at(13));
}

TEST_F(Readings, ABitThatOneReadingShowsIsNone) {
  for (int second = 10; second < 20; second += 2) {
    EXPECT_THAT(read(0x1, 0x1, second), IsEmpty());
    EXPECT_THAT(read(0x80001, 0x1, second + 1), IsEmpty());
  }
}

TEST_F(Readings, TwoBitsOneAfterTheOtherAreTwoChanges) {
  EXPECT_THAT(read(0x1, 0x1, 10), IsEmpty());
  EXPECT_THAT(read(0x80001, 0x1, 11), IsEmpty());
  EXPECT_THAT(read(0x180001, 0x1, 12), ElementsAre(testing::Field(&ConditionChanged::condition, Condition::cw_limit)));
  EXPECT_TRUE(conditions_.status_doubtful());
  EXPECT_THAT(read(0x180001, 0x1, 13), ElementsAre(testing::Field(&ConditionChanged::seen, at(12))));
}

TEST_F(Readings, WhatTheFirstReadingsShowHasNoReadingBefore) {
  EXPECT_THAT(read(0x20, 0x1, 10), IsEmpty());
  const auto found = read(0x20, 0x1, 11);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].before, TimePoint{});
  EXPECT_EQ(found[0].seen, at(10));
}

TEST_F(Readings, WhatEveryMotionShowsIsNoChange) {
  read(0x1, 0x1, 10);
  for (int second = 11; second < 14; ++second) {
    EXPECT_THAT(read(0x1878003, 0x1, second), IsEmpty());  // bits 16 to 19, 24, 25, and a refused command
  }
}

TEST_F(Readings, AModeCountsAtOnce) {
  EXPECT_THAT(conditions_.mode_read("HOST", at(10)), IsEmpty());
  EXPECT_THAT(conditions_.mode_read("HOST,MS", at(11)), IsEmpty()) << "entered by a command";
  const auto left = conditions_.mode_read("MANUAL", at(12));
  ASSERT_EQ(left.size(), 1u);
  EXPECT_TRUE(left[0].begun);
  EXPECT_EQ(left[0].value, "MANUAL");
  EXPECT_EQ(left[0].before, at(11));
  EXPECT_THAT(conditions_.mode_read("MANUAL", at(13)), IsEmpty());
  const auto back = conditions_.mode_read("HOST", at(14));
  ASSERT_EQ(back.size(), 1u);
  EXPECT_FALSE(back[0].begun);
  EXPECT_EQ(back[0].before, at(13));
  EXPECT_EQ(back[0].seen, at(14));
}

}  // namespace
}  // namespace axisgate::shrc203::conditions_test
