// Latches: which callers a stop holds back, and who may rearm.
#include "tests/unit/access/lease_fixture.h"

namespace axisgate::server::latches_test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

class LatchesTest : public LeaseFixture {};

TEST_F(LatchesTest, AnothersStopHoldsTheHolderBackUntilRearm) {
  const LeaseToken token = held_by("anna", kBoth);
  stop_by("bert", kOne);
  now_ += seconds(3);
  EXPECT_EQ(may("anna", token, kOne), Reason::stopped_by);
  EXPECT_THAT(told_, HasSubstr("bert stopped axis 1 (3 s ago)"));
  EXPECT_EQ(may("anna", token, kTwo), kAllowed);
  EXPECT_EQ(rearm("anna", token), kOne);
  EXPECT_EQ(may("anna", token, kOne), kAllowed);
}

// The motion waits in the queue when the stop arrives, and is withdrawn.
TEST_F(LatchesTest, WhoWaitsToMoveIsHeldBackAsWhoMoves) {
  stop_by("unix bert", kOne, 0, {{"unix anna", 0, kOne, 7}, {"unix bert", 0, kOne, 8}});
  EXPECT_EQ(may("unix anna", 0, kOne), Reason::stopped_by);
  EXPECT_EQ(may("unix anna", 0, kTwo), kAllowed);
  EXPECT_EQ(may("unix bert", 0, kOne), kAllowed);
  EXPECT_EQ(rearm("unix anna"), kOne);
  EXPECT_EQ(may("unix anna", 0, kOne), kAllowed);
}

TEST_F(LatchesTest, TheHoldersOwnStopHoldsNobodyBack) {
  const LeaseToken token = held_by("anna", kOne);
  stop_by("anna", kOne, token);
  EXPECT_EQ(may("anna", token, kOne), kAllowed);
}

// The same session stops over another connection, or without its lease token.
TEST_F(LatchesTest, AProgramsOwnStopHoldsItNotBack) {
  const std::string one = "tcp 127.0.0.1:40000", other = "tcp 127.0.0.1:40001", session = "0f9d2c71";
  leases_.begin({one, 0, kOne, 1, session}, {}, now_);
  leases_.stop_asked({other, 0, kOne, 0, session}, {{one, 0, kOne, 2, session}}, now_);
  EXPECT_EQ(may(one, 0, kOne), kAllowed);
  EXPECT_EQ(may(other, 0, kOne), kAllowed);
  leases_.end(1, now_);
  leases_.stop_asked({other, 0, kOne, 0, "another1"}, {}, now_);
  EXPECT_EQ(may(one, 0, kOne), Reason::stopped_by);
  rearm(one);

  LeaseToken token = 0;
  leases_.acquire({.scope = kOne, .session = session}, one, false, now_, now_,
                  [&](const Result<Lease>& lease) { token = lease->token; });
  leases_.stop_asked({other, 0, kOne, 0, session}, {}, now_);
  EXPECT_EQ(may(one, token, kOne), kAllowed);
  leases_.stop_asked({other, 0, kOne, 0}, {}, now_);
  EXPECT_EQ(may(one, token, kOne), Reason::stopped_by);
}

TEST_F(LatchesTest, ALatchOutlivesItsLease) {
  const LeaseToken token = held_by("anna", kOne);
  stop_by("bert", kOne);
  ASSERT_TRUE(leases_.release(token, now_));
  const LeaseToken next = held_by("anna", kOne);
  EXPECT_EQ(may("anna", next, kOne), Reason::stopped_by);
  EXPECT_EQ(rearm("anna"), kOne);
  EXPECT_EQ(may("anna", next, kOne), kAllowed);
}

// The stop comes from another terminal, which has no token.
TEST_F(LatchesTest, AnOwnStopEndsWithTheLeaseAndHidesNoOther) {
  const LeaseToken first = held_by("unix anna", kOne);
  stop_by("unix anna", kOne);
  EXPECT_EQ(may("unix anna", first, kOne), Reason::stopped_by);
  ASSERT_TRUE(leases_.release(first, now_));
  const LeaseToken second = held_by("unix anna", kOne);
  EXPECT_EQ(may("unix anna", second, kOne), kAllowed);
  stop_by("unix bert", kOne);
  stop_by("unix anna", kOne);
  ASSERT_TRUE(leases_.release(second, now_));
  EXPECT_EQ(may("unix anna", held_by("unix anna", kOne), kOne), Reason::stopped_by);
}

TEST_F(LatchesTest, ANamedCallerRearmsItsLeaseWithoutTheToken) {
  const LeaseToken token = held_by("unix anna", kOne);
  stop_by("unix bert", kOne);
  EXPECT_EQ(rearm("unix bert"), Scope());
  EXPECT_EQ(may("unix anna", token, kOne), Reason::stopped_by);
  EXPECT_EQ(rearm("unix anna"), kOne);
  EXPECT_EQ(may("unix anna", token, kOne), kAllowed);
}

TEST_F(LatchesTest, AnAnonymousCallerRearmsNobodysLease) {
  const LeaseToken token = held_by("tcp 127.0.0.1:40000", kOne);
  stop_by("unix bert", kOne);
  EXPECT_EQ(rearm("tcp 127.0.0.1:40000"), Scope());
  EXPECT_EQ(may("tcp 127.0.0.1:40000", token, kOne), Reason::stopped_by);
  EXPECT_EQ(rearm("tcp 127.0.0.1:40000", token), kOne);
}

// Each row: who stopped, who had moved, and who may then not move the axis.
TEST_F(LatchesTest, WhomAStopHoldsBack) {
  const std::string anna = "unix anna", bert = "unix bert", tcp = "tcp 127.0.0.1:40000", other = "tcp 127.0.0.1:40001";
  struct Row {
    std::string stopped, moved;
    std::vector<std::string> held_back;
  };
  const std::vector<Row> rows = {
      {anna, anna, {}},
      {bert, anna, {anna, tcp, other}},
      {tcp, anna, {anna, tcp, other}},
      {"token scan", anna, {anna, tcp, other}},
      {anna, "cert anna", {"cert anna", tcp, other}},
      {anna, tcp, {tcp, other}},
      {tcp, tcp, {tcp, other}},
      {other, tcp, {tcp, other}},
  };
  for (const Row& row : rows) {
    Leases leases(tokens_);
    leases.begin({row.moved, 0, kOne, 1}, {}, now_);
    leases.stop_asked({row.stopped, 0, kOne, 0}, {}, now_);
    leases.end(1, now_);
    std::vector<std::string> held_back;
    for (const std::string& who : {anna, bert, std::string("token scan"), std::string("cert anna"), tcp, other}) {
      if (!leases.authorize({who, 0, kOne, 0}, now_)) held_back.push_back(who);
    }
    EXPECT_EQ(held_back, row.held_back) << row.moved << " stopped by " << row.stopped;
  }
}

TEST_F(LatchesTest, AnonymousCallersRearmForThemselves) {
  begin(1, "unix anna", 0, kOne);
  stop_by("unix bert", kOne);
  leases_.end(1, now_);
  EXPECT_EQ(rearm("tcp 127.0.0.1:40000"), kOne);
  EXPECT_EQ(may("tcp 127.0.0.1:40001", 0, kOne), kAllowed);
  EXPECT_EQ(may("unix anna", 0, kOne), Reason::stopped_by);
  EXPECT_EQ(rearm("unix anna"), kOne);
  EXPECT_EQ(may("unix anna", 0, kOne), kAllowed);
}

TEST_F(LatchesTest, RearmSaysWhatItReleased) {
  begin(1, "unix anna", 0, kBoth);
  stop_by("unix bert", kOne);
  stop_by("unix bert", kTwo);
  stop_by("unix carl", kTwo);
  const auto lifted = leases_.rearm(0, "unix anna", now_);
  ASSERT_EQ(lifted.size(), 2u);
  EXPECT_EQ(lifted[0].by, "unix bert");
  EXPECT_EQ(lifted[0].scope, kBoth);
  EXPECT_EQ(lifted[1].by, "unix carl");
}

TEST_F(LatchesTest, AnothersStopHoldsBackALoopWithoutALease) {
  begin(1, "anna", 0, kOne);
  leases_.end(1, now_);
  now_ += seconds(1);  // between two motions
  stop_by("bert", AxisSet::first(3));
  EXPECT_EQ(may("anna", 0, kOne), Reason::stopped_by);
  EXPECT_EQ(may("anna", 0, kTwo), kAllowed);
  EXPECT_EQ(may("bert", 0, kOne), kAllowed);
  now_ += seconds(3600);
  EXPECT_EQ(may("anna", 0, kOne), Reason::stopped_by) << "until rearm";
  EXPECT_EQ(rearm("anna"), kOne);
  EXPECT_EQ(may("anna", 0, kOne), kAllowed);
}

TEST_F(LatchesTest, OnesOwnStopDoesNotHoldOneBack) {
  begin(1, "anna", 0, kOne);
  stop_by("anna", kOne);
  leases_.end(1, now_);
  EXPECT_EQ(may("anna", 0, kOne), kAllowed);
}

// The holder has released the lease, and the running motion may finish.
TEST_F(LatchesTest, AStopWhileALeaseEndsHoldsItsHolderBack) {
  const LeaseToken token = held_by("unix anna", kOne, AtLoss::finish);
  begin(1, "unix anna", token, kOne);
  ASSERT_TRUE(leases_.release(token, now_));
  stop_by("unix bert", kOne);
  leases_.end(1, now_);
  EXPECT_EQ(may("unix anna", 0, kOne), Reason::stopped_by);
}

// `axisctl move --wait` takes a lease for each move.
TEST_F(LatchesTest, AStopBetweenTwoShortLeasesHoldsALoopBack) {
  const LeaseToken token = held_by("unix anna", kOne);
  begin(1, "unix anna", token, kOne);
  leases_.end(1, now_);
  ASSERT_TRUE(leases_.release(token, now_));
  now_ += seconds(1);
  stop_by("unix bert", kOne);
  EXPECT_EQ(may("unix anna", held_by("unix anna", kOne), kOne), Reason::stopped_by);
}

TEST_F(LatchesTest, AStopHoldsAllBackWhoMovedTheAxis) {
  for (const char* who : {"unix anna", "unix carl"}) {
    begin(1, who, 0, kOne);
    leases_.end(1, now_);
  }
  stop_by("unix bert", kOne);
  EXPECT_EQ(may("unix anna", 0, kOne), Reason::stopped_by);
  EXPECT_EQ(may("unix carl", 0, kOne), Reason::stopped_by);
}

// The lease's holder has passed its token to another program.
TEST_F(LatchesTest, AStopHoldsBackWhoMovedUnderAnothersLease) {
  const LeaseToken token = held_by("unix anna", kOne);
  begin(1, "token scan", token, kOne);
  stop_by("unix bert", kOne);
  leases_.end(1, now_);
  ASSERT_TRUE(leases_.release(token, now_));
  EXPECT_EQ(may("token scan", 0, kOne), Reason::stopped_by);
}

// Users of the Unix socket who share the name "unix" because they have no name of their own.
TEST_F(LatchesTest, UsersWhoShareANameAreAnonymous) {
  begin(1, "unix", 0, kOne);
  stop_by("unix", kOne);
  leases_.end(1, now_);
  EXPECT_EQ(may("unix", 0, kOne), Reason::stopped_by);
}

TEST_F(LatchesTest, WhatEverybodySeesHasNoToken) {
  held_by("unix anna", kOne);
  EXPECT_EQ(leases_.held().at(0).sealed_token, "");
}

TEST_F(LatchesTest, RearmNamesAStopOnceThatLatchedLeaseAndMover) {
  const LeaseToken token = held_by("unix anna", kBoth);
  begin(1, "unix anna", token, kOne);
  stop_by("unix bert", kBoth);
  const auto lifted = leases_.rearm(0, "unix anna", now_);
  ASSERT_EQ(lifted.size(), 1u);
  EXPECT_EQ(lifted[0].scope, kBoth);
}

}  // namespace
}  // namespace axisgate::server::latches_test
