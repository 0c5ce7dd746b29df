// Tests of when the spindle turns, and at which speed (guideline 5-2, 3-3 !MC and !RC).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Played played(const std::string& job) { return play(job, test_profile(), kMidway); }

class Starts : public testing::TestWithParam<const char*> {};
TEST_P(Starts, WithACommandThatMoves) {
  const Played found = played(std::string(GetParam()) + ";");
  EXPECT_THAT(found.waits, ElementsAre("spin up 2"));
  ASSERT_FALSE(found.moves.empty());
  for (const Move& move : found.moves) EXPECT_TRUE(move.turning);
}
INSTANTIATE_TEST_SUITE_P(Guideline52, Starts,
                         testing::Values("PD", "PD9,9", "PU9,9", "PA9,9", "PR9,9", "M9,9", "R9,9", "D", "D9,9", "I",
                                         "I9,9", "Z9,9,9", "!ZZ9,9,9", "!ZEX9", "!ZEZ9", "!ZM-10", "@-9,9;PU"));

// "At the time of a command that involves movement", even if the tool is already at the target.
class StartsInPlace : public testing::TestWithParam<const char*> {};
TEST_P(StartsInPlace, WithACommandThatMayMove) {
  const Played found = played(std::string(GetParam()) + ";");
  EXPECT_THAT(found.waits, ElementsAre("spin up 2"));
  EXPECT_THAT(found.moves, IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(Guideline52, StartsInPlace,
                         testing::Values("PU", "PU0,0", "M", "M0,0", "R0,0", "PA0,0", "Z0,0,5000", "!ZEX0", "!ZEA0",
                                         "!ZM0", "^IN;!ZM0"));

class DoesNotStart : public testing::TestWithParam<const char*> {};
TEST_P(DoesNotStart, WithoutACommandThatMoves) {
  const Played found = played(std::string(GetParam()) + ";");
  EXPECT_THAT(found.waits, IsEmpty());
  EXPECT_THAT(found.moves, IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(Guideline52, DoesNotStart,
                         testing::Values("F5", "VS5", "V5", "!VZ5", "W0", "!DW0", "@-9,9", "!PZ-9,9", "!MC", "!MC1",
                                         "!MC0", "!RC5", "!ZO-9", "!NR", "DF", "IN", "H", "PA", "PR", "Z", "!ZZ",
                                         "Z1,2", "!ZE", "!ZE::", "!ZEU9", "!ZM", "!ZM1"));

struct SpinUps {
  const char* job;
  std::size_t count;
};
void PrintTo(const SpinUps& one, std::ostream* out) { *out << one.job; }

class Counts : public testing::TestWithParam<SpinUps> {};
TEST_P(Counts, SpinUps) { EXPECT_EQ(played(GetParam().job).waits.size(), GetParam().count); }
INSTANTIATE_TEST_SUITE_P(OfAJob, Counts,
                         testing::Values(SpinUps{"PD;PU9,9;PD8,8;Z7,7,7;!ZM-10;", 1},
                                         // !MC 0, IN and H stop the spindle, and the next movement starts it again.
                                         SpinUps{"PD;!MC0;!MC1;PU;", 2}, SpinUps{"PD;IN;PD;", 2},
                                         SpinUps{"PD;H;PD;", 2},
                                         // DF and a parameter that is not 0 do not stop it.
                                         SpinUps{"PD;DF;PU;", 1}, SpinUps{"PD;!MC1;PU;", 1}, SpinUps{"PD;!MC;PU;", 1},
                                         // Only !MC 1, IN and DF permit the spindle again; H does not.
                                         SpinUps{"!MC0;PD;PU;", 0}, SpinUps{"!MC0;PD;H;PD;", 0},
                                         SpinUps{"!MC0;!MC1;PD;", 1}, SpinUps{"!MC0;!MC;PD;", 1},
                                         SpinUps{"!MC0;!MC-1;PD;", 1}, SpinUps{"!MC0;IN;PD;", 1},
                                         SpinUps{"!MC0;DF;PD;", 1}, SpinUps{"!MC0;!RC15;PD;", 0},
                                         // H and IN move, but do not start the spindle (interpretation of 5-2: they
                                         // stop it).
                                         SpinUps{"!MC0;PD;!MC1;H;", 0}, SpinUps{"!MC0;PD;IN;", 0}));

TEST(Spindle, StandsStillWhereItIsForbidden) {
  for (const Move& move : played("!MC0;PD9,9;PU;").moves) EXPECT_FALSE(move.turning);
}

// "Stop the spindle motor" takes effect after the tool is up.
TEST(Spindle, TurnsWhileInAndHLiftTheTool) {
  const Profile profile = test_profile();
  for (const char* job : {"PD;IN;", "PD;H;"}) {
    const Played found = played(job);
    ASSERT_EQ(found.moves.size(), 2u) << job;
    EXPECT_TRUE(found.moves[1].turning) << job;
    EXPECT_FALSE(checked(job, profile, {kMidway, {}, {}})->machine().spindle_turns()) << job;
  }
}

TEST(Spindle, StopsWithMc0) {
  const Profile profile = test_profile();
  EXPECT_TRUE(checked("PD;", profile)->machine().spindle_turns());
  EXPECT_FALSE(checked("PD;!MC0;", profile)->machine().spindle_turns());
}

TEST(Spindle, SpinUpIsPartOfTheTime) {
  Profile profile = test_profile();
  const auto with = checked("PD;PU;", profile)->summary();
  profile.spindle.spin_up_s = 7;
  const auto longer = checked("PD;PU;", profile)->summary();
  EXPECT_EQ(with.spin_ups, 1u);
  EXPECT_NEAR(longer.seconds_high - with.seconds_high, 5, 1e-9);
  EXPECT_EQ(longer.seconds_low, with.seconds_low) << "it may need none";
}

double rpm(Spindle::Law law, const std::string& job) {
  Profile profile = test_profile();
  profile.spindle.law = law;
  profile.spindle.minimum_rpm = 1000;
  profile.spindle.maximum_rpm = 16000;
  return checked(job, profile)->machine().rpm();
}

TEST(Revolutions, OfAFixedSpindleAreAlwaysTheSame) {
  for (const char* job : {"!RC0;", "!RC15;", "!RC3124;"}) EXPECT_EQ(rpm(Spindle::Law::fixed, job), 16000) << job;
}

// 15 steps from 1000 to 16000. "Values higher than 15 are clipped to 15."
TEST(Revolutions, AreSetInStages) {
  for (const auto law : {Spindle::Law::stages, Spindle::Law::direct}) {
    EXPECT_EQ(rpm(law, "!RC0;"), 1000);
    EXPECT_EQ(rpm(law, "!RC3;"), 4000);
    EXPECT_EQ(rpm(law, "!RC3.9;"), 4000);
    EXPECT_EQ(rpm(law, "!RC15;"), 16000);
    EXPECT_EQ(rpm(law, "!RC16;"), 16000);
    EXPECT_EQ(rpm(law, "!RC99;"), 16000);
  }
}

TEST(Revolutions, AreSetDirectlyFrom100On) {
  EXPECT_EQ(rpm(Spindle::Law::direct, "!RC3124;"), 3124);
  EXPECT_EQ(rpm(Spindle::Law::direct, "!RC100;"), 1000);
  EXPECT_EQ(rpm(Spindle::Law::direct, "!RC8388607;"), 16000);
}

// "On models not capable of specifying direct rpm, the value is clipped at 15 and the maximum spindle speed is used."
TEST(Revolutions, AreTheHighestWhereDirectIsNotPossible) {
  EXPECT_EQ(rpm(Spindle::Law::stages, "!RC100;"), 16000);
  EXPECT_EQ(rpm(Spindle::Law::stages, "!RC3124;"), 16000);
}

TEST(Revolutions, StayWithoutParameterAndInError) {
  const std::string set = "!RC3;";
  for (const char* job : {"!RC;", "!RC-1;", "!RC8388608;", "H;", "!MC0;!MC1;"}) {
    EXPECT_EQ(rpm(Spindle::Law::direct, set + job), 4000) << job;
  }
}

// 2000 + 4 * 500. No stage exceeds the spindle's range.
TEST(Revolutions, FollowTheProfilesStages) {
  Spindle spindle;
  spindle.law = Spindle::Law::stages;
  spindle.minimum_rpm = 2500;
  spindle.maximum_rpm = 9000;
  spindle.stage_0_rpm = 2000;
  spindle.rpm_per_stage = 500;
  EXPECT_EQ(spindle.rpm(4), 4000);
  EXPECT_EQ(spindle.rpm(0), 2500);
  EXPECT_EQ(spindle.rpm(15), 9000);
}

}  // namespace
}  // namespace axisgate::rml1
