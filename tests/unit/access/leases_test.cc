// Leases: who holds which axes, and who waits.
#include "tests/unit/access/lease_fixture.h"

namespace axisgate::server::leases_test {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LeasesTest : public LeaseFixture {};

TEST_F(LeasesTest, TokensBearTheGenerationAndGrow) {
  const LeaseToken first = held_by("anna", kOne), second = held_by("bert", kTwo);
  EXPECT_EQ(first >> 32, 7u);
  EXPECT_GT(second, first);
  EXPECT_GT(LeaseTokens(8).next(), second);
}

TEST_F(LeasesTest, OnlyTheTokenMayMoveTheLeasedAxes) {
  const LeaseToken token = held_by("anna", kOne);
  EXPECT_EQ(may("anna", token, kOne), kAllowed);
  EXPECT_EQ(may("anna", token, kTwo), Reason::outside_lease);
  EXPECT_EQ(may("bert", 0, kOne), Reason::lease_held);
  EXPECT_EQ(may("anna", 0, kOne), Reason::lease_held) << "the holder is the lease, not the person";
  EXPECT_EQ(may("bert", 0, kTwo), kAllowed);
  EXPECT_EQ(may("bert", token + 1, kTwo), Reason::lease_lost);
}

TEST_F(LeasesTest, ARefusalSaysWhoHoldsItAndSinceWhen) {
  leases_.acquire({.scope = kOne, .purpose = "overnight scan"}, "anna", false, now_, now_, [](const Result<Lease>&) {});
  now_ += seconds(5);
  may("bert", 0, kBoth);
  EXPECT_EQ(told_, "anna has held axis 1 for 5 s (\"overnight scan\")");
}

TEST_F(LeasesTest, TwoHundredAndFiftySixWait) {
  held_by("anna", kOne);
  for (int i = 0; i < 256; ++i) ASSERT_NE(wait_for("bert", kOne), 0u) << i;
  EXPECT_EQ(wait_for("late", kOne), 0u);
  EXPECT_THAT(answers_, ElementsAre("late QUEUE_FULL"));
}

TEST_F(LeasesTest, ALeaseExpiresUnlessItIsKeptAlive) {
  const LeaseToken token = held_by("anna", kOne);
  pass(seconds(9));
  ASSERT_TRUE(leases_.keep_alive(token, now_));
  pass(seconds(9));
  EXPECT_EQ(may("anna", token, kOne), kAllowed);
  pass(seconds(1));
  EXPECT_EQ(may("anna", token, kOne), Reason::lease_lost);
  EXPECT_THAT(told_, HasSubstr("expired"));
  EXPECT_EQ(leases_.keep_alive(token, now_).error().reason, Reason::lease_lost);
  EXPECT_EQ(may("bert", 0, kOne), kAllowed);
  EXPECT_THAT(leases_.held(), IsEmpty());
}

TEST_F(LeasesTest, TheAxesAreNobodysUntilTheSettingsAreRestored) {
  const LeaseToken token = held_by("anna", kOne);
  leases_.settings_changed(token);
  wait_for("bert", kOne);
  ASSERT_TRUE(leases_.release(token, now_));
  EXPECT_THAT(answers_, IsEmpty());
  EXPECT_EQ(leases_.next_deadline(), TimePoint{});
  const auto orders = leases_.advance(now_);
  ASSERT_EQ(orders.restoring.size(), 1u);
  EXPECT_EQ(orders.restoring[0].token, token);
  EXPECT_EQ(orders.restoring[0].who, "anna");
  EXPECT_THAT(leases_.advance(now_).restoring, IsEmpty()) << "asked for twice";
  EXPECT_EQ(may("anna", token, kOne), Reason::lease_lost);
  leases_.settings_restored(token, now_);
  EXPECT_THAT(answers_, ElementsAre("bert has it"));
}

TEST_F(LeasesTest, AHandOverWaitsForTheSettings) {
  const LeaseToken token = held_by("anna", kOne);
  leases_.settings_changed(token);
  wait_for("carl", kOne);
  wait_for("bert", kOne);
  ASSERT_TRUE(leases_.hand_over(token, "bert", now_));
  EXPECT_THAT(answers_, IsEmpty());
  leases_.settings_restored(token, now_);
  EXPECT_THAT(answers_, ElementsAre("bert has it"));
}

TEST_F(LeasesTest, ThoseWhoWaitGetItInTheirOrder) {
  const LeaseToken token = held_by("anna", kBoth);
  wait_for("bert", kBoth);
  wait_for("carl", kOne);
  ASSERT_EQ(leases_.waiting(now_).size(), 2u);
  EXPECT_EQ(leases_.waiting(now_)[1].place, 2);
  ASSERT_TRUE(leases_.release(token, now_));
  EXPECT_THAT(answers_, ElementsAre("bert has it"));
  ASSERT_TRUE(leases_.release(granted_, now_));
  EXPECT_THAT(answers_, ElementsAre("bert has it", "carl has it"));
}

TEST_F(LeasesTest, NobodyOvertakesOneWhoWaits) {
  held_by("anna", kOne);
  wait_for("bert", kBoth);
  EXPECT_EQ(acquire("carl", kTwo).error().reason, Reason::lease_held);
  EXPECT_EQ(may("carl", 0, kTwo), Reason::lease_held);
  EXPECT_THAT(told_, HasSubstr("bert has waited for"));
}

TEST_F(LeasesTest, TheExpectedWaitIsWhatThoseInFrontHaveSaid) {
  leases_.acquire({.scope = kOne, .expected_use = seconds(30)}, "anna", false, now_, now_, [](const Result<Lease>&) {});
  wait_for("bert", kOne, seconds(5));
  wait_for("carl", kOne);
  wait_for("dora", kOne);
  now_ += seconds(10);
  const auto waiting = leases_.waiting(now_);
  EXPECT_EQ(waiting[0].expected_wait, Duration(seconds(20)));
  EXPECT_EQ(waiting[1].expected_wait, Duration(seconds(25)));
  EXPECT_FALSE(waiting[2].expected_wait) << "carl has not said how long";
}

TEST_F(LeasesTest, WaitingHasALimit) {
  held_by("anna", kOne);
  wait_for("bert", kOne);
  for (int i = 0; i < 61; ++i) {
    pass(seconds(1));
    (void)leases_.keep_alive(leases_.held()[0].token, now_);
  }
  EXPECT_THAT(answers_, ElementsAre("bert DEADLINE_PASSED"));
}

TEST_F(LeasesTest, OneWhoWaitsNoLongerIsForgotten) {
  const LeaseToken token = held_by("anna", kOne);
  const auto waiting = wait_for("bert", kOne);
  leases_.withdraw(waiting, now_);
  EXPECT_THAT(answers_, ElementsAre("bert NOT_SENT"));
  ASSERT_TRUE(leases_.release(token, now_));
  EXPECT_EQ(may("carl", 0, kOne), kAllowed);
}

TEST_F(LeasesTest, WhoWillNotWaitLearnsWhoMoves) {
  begin(7, "bert", 0, kOne);
  const auto refused = acquire("anna", kBoth);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::lease_held);
  EXPECT_EQ(refused.error().message, "axis 1 is in motion 7 (move by bert)");
  EXPECT_THAT(refused.error().hint, HasSubstr("acquire a lease with `wait`"));
  leases_.due(7, now_ + std::chrono::milliseconds(3500));
  EXPECT_EQ(acquire("anna", kOne).error().message, "axis 1 is in motion 7 (move by bert, 4 s left)");
  EXPECT_TRUE(acquire("anna", kTwo));
  EXPECT_EQ(may("carl", 0, kOne), kAllowed) << "a motion waits for its turn instead";
}

TEST_F(LeasesTest, WhoHasWaitedInVainLearnsWhoMoved) {
  begin(7, "bert", 0, kOne);
  Problem problem;
  leases_.acquire({.scope = kOne}, "anna", true, now_ + seconds(3), now_,
                  [&](const Result<Lease>& lease) { problem = lease ? Problem() : lease.error(); });
  pass(seconds(4));
  EXPECT_EQ(problem.reason, Reason::deadline_passed);
  EXPECT_THAT(problem.message, HasSubstr("axis 1 is in motion 7 (move by bert)"));
}

// Each motion is refused, however many wait already, and asks again at its turn.
TEST_F(LeasesTest, NoMotionWithoutALeaseOvertakesALeaseThatWaits) {
  begin(1, "bert", 0, kOne);
  wait_for("anna", kBoth);
  EXPECT_EQ(may("bert", 0, kOne, 2), Reason::lease_held);
  EXPECT_EQ(may("bert", 0, kTwo, 3), Reason::lease_held);
  leases_.end(1, now_);
  EXPECT_THAT(answers_, ElementsAre("anna has it"));
}

TEST_F(LeasesTest, ALeaseWaitsForAMotionWithoutOne) {
  begin(1, "bert", 0, kOne);
  wait_for("anna", kOne);
  EXPECT_THAT(answers_, IsEmpty());
  EXPECT_EQ(may("bert", 0, kOne, 1), kAllowed) << "what runs may send on";
  leases_.end(1, now_);
  EXPECT_THAT(answers_, ElementsAre("anna has it"));
}

TEST_F(LeasesTest, WhatRunsUnderAnExpiredLeaseIsStopped) {
  const LeaseToken token = held_by("anna", kOne);
  begin(1, "anna", token, kOne);
  wait_for("bert", kOne);
  pass(seconds(10));
  ASSERT_EQ(orders_.size(), 1u);
  EXPECT_EQ(orders_[0].scope, kOne);
  EXPECT_EQ(orders_[0].who, "anna");
  EXPECT_EQ(may("anna", token, kOne, 1), Reason::lease_lost);
  EXPECT_THAT(answers_, IsEmpty()) << "it still moves";
  leases_.end(1, now_);
  EXPECT_THAT(answers_, ElementsAre("bert has it"));
}

TEST_F(LeasesTest, WhatMayFinishFinishesAndNothingElseBegins) {
  const LeaseToken token = held_by("anna", kOne, AtLoss::finish);
  begin(1, "anna", token, kOne);
  pass(seconds(10));
  EXPECT_THAT(orders_, IsEmpty());
  EXPECT_EQ(may("anna", token, kOne, 1), kAllowed);
  EXPECT_EQ(may("anna", token, kOne, 2), Reason::lease_lost);
  EXPECT_EQ(acquire("bert", kOne).error().reason, Reason::lease_held);
  leases_.end(1, now_);
  EXPECT_TRUE(acquire("bert", kOne));
}

TEST_F(LeasesTest, AHolderWhoIsCutOffMayComeBackInTime) {
  const LeaseToken token = held_by("anna", kOne);
  begin(1, "anna", token, kOne);
  leases_.lost(token, now_);
  pass(seconds(1));
  EXPECT_EQ(orders_.size(), 1u);
  EXPECT_TRUE(leases_.keep_alive(token, now_));
}

TEST_F(LeasesTest, StopAndReleaseEndsWithTheConnection) {
  const LeaseToken token = held_by("anna", kOne, AtLoss::stop_and_release);
  begin(1, "anna", token, kOne);
  leases_.lost(token, now_);
  pass(seconds(0));
  EXPECT_EQ(orders_.size(), 1u);
  EXPECT_EQ(leases_.keep_alive(token, now_).error().reason, Reason::lease_lost);
}

TEST_F(LeasesTest, WhoIsCutOffForGoodLosesAllLeases) {
  const LeaseToken token = held_by("anna", kOne), berts = held_by("bert", kTwo);
  begin(1, "anna", token, kOne);
  wait_for("anna", kTwo);
  wait_for("carl", kOne);
  leases_.cut_off("anna", "chief", now_);
  pass(seconds(0));
  EXPECT_EQ(orders_.size(), 1u);
  EXPECT_EQ(leases_.keep_alive(token, now_).error().reason, Reason::lease_lost);
  EXPECT_TRUE(leases_.keep_alive(berts, now_));
  EXPECT_THAT(answers_, ElementsAre("anna NOT_SENT"));
  leases_.end(1, now_);
  leases_.stopped(orders_[0].id, now_);
  EXPECT_THAT(answers_, ElementsAre("anna NOT_SENT", "carl has it"));
}

TEST_F(LeasesTest, WhoIsCutOffForGoodFinishesWhatMayFinish) {
  const LeaseToken token = held_by("anna", kOne, AtLoss::finish);
  begin(1, "anna", token, kOne);
  leases_.cut_off("anna", "chief", now_);
  pass(seconds(0));
  EXPECT_THAT(orders_, IsEmpty());
  EXPECT_EQ(may("anna", token, kOne, 1), kAllowed);
  EXPECT_EQ(may("anna", token, kOne, 2), Reason::lease_lost);
}

TEST_F(LeasesTest, HandingOverPassesTheLine) {
  const LeaseToken token = held_by("anna", kBoth);
  wait_for("bert", kOne);
  wait_for("carl", kOne);
  EXPECT_EQ(leases_.hand_over(token, "dora", now_).error().reason, Reason::not_found);
  begin(1, "anna", token, kOne);
  EXPECT_EQ(leases_.hand_over(token, "carl", now_).error().reason, Reason::axis_busy);
  leases_.end(1, now_);
  ASSERT_TRUE(leases_.hand_over(token, "carl", now_));
  EXPECT_THAT(answers_, ElementsAre("carl has it"));
  EXPECT_EQ(may("anna", token, kOne), Reason::lease_lost);
  EXPECT_THAT(told_, HasSubstr("handed over to carl"));
}

TEST_F(LeasesTest, ATakeOverStopsFirst) {
  const LeaseToken token = held_by("anna", kBoth);
  begin(1, "anna", token, kOne);
  wait_for("bert", kOne);
  leases_.take_over({.scope = kOne}, "chief", now_,
                    [this](const Result<Lease>& lease) { answers_.push_back(lease ? "chief has it" : "refused"); });
  EXPECT_EQ(may("anna", token, kOne, 1), Reason::lease_lost) << "not a byte more";
  pass(seconds(0));
  ASSERT_EQ(orders_.size(), 1u);
  leases_.end(1, now_);
  EXPECT_THAT(answers_, IsEmpty()) << "the stop is still under way";
  leases_.stopped(orders_[0].id, now_);
  EXPECT_THAT(answers_, ElementsAre("chief has it"));
}

TEST_F(LeasesTest, ATakeOverEndsAMotionWithoutALease) {
  begin(1, "anna", 0, kOne);
  leases_.take_over({.scope = kOne}, "chief", now_, [](const Result<Lease>&) {});
  EXPECT_EQ(may("anna", 0, kOne, 1), Reason::lease_lost);
}

TEST_F(LeasesTest, ARestartOfTheControllerEndsAllLeases) {
  const LeaseToken token = held_by("anna", kOne);
  leases_.device_restarted(now_);
  EXPECT_EQ(may("anna", token, kOne), Reason::lease_lost);
  EXPECT_THAT(told_, HasSubstr("restarted"));
}

TEST_F(LeasesTest, QuestionsNeedNothing) {
  held_by("anna", AxisSet::first(3));
  EXPECT_EQ(may("bert", 12345, AxisSet()), kAllowed);
}

}  // namespace
}  // namespace axisgate::server::leases_test
