// Hazards of sharing: the right to move axes, and callers who were stopped. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "server/access/leases.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using server::AtLoss;
using server::Lease;
using server::LeaseToken;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::IsEmpty;

class HazardOfSharing : public testing::Test {
 protected:
  HazardOfSharing() { EXPECT_TRUE(world.run_until_up()) << world.replay(); }

  LeaseToken lease(const std::string& holder, AxisSet axes, AtLoss at_loss = AtLoss::stop) {
    LeaseToken token = 0;
    leases.acquire({.scope = axes, .at_loss = at_loss}, holder, false, world.now(), world.now(),
                   [&](const Result<Lease>& got) { token = got ? got->token : 0; });
    EXPECT_NE(token, 0u);
    return token;
  }
  RequestContext context(const std::string& who, LeaseToken token) {
    RequestContext asked = world.context(who);
    asked.lease = token;
    return asked;
  }
  // Returns the reason of an immediate refusal, or unspecified if the motion was accepted. Later outcomes are in the
  // world's outcomes.
  Reason move(const std::string& who, LeaseToken token, int axis, std::int64_t way) {
    MoveRequest request = move_of(world, {{axis, way}}, true);
    request.context = context(who, token);
    const auto reason = std::make_shared<Reason>(Reason::unspecified);
    world.controller().move(std::move(request), world.now(), [this, reason](const Result<Motion>& motion) {
      if (motion) return;
      *reason = motion.error().reason;
      told = motion.error().message;
    });
    return *reason;
  }
  void run_until_written(std::string_view prefix) {
    EXPECT_TRUE(world.run_until([&] { return world.wire().commands().back().starts_with(prefix); }, seconds(5)))
        << world.replay();
  }
  StopReport stop_by(const std::string& who, LeaseToken token = 0) {
    std::optional<StopReport> report;
    world.controller().stop({}, context(who, token), world.now(), [&](const StopReport& told_of) { report = told_of; });
    EXPECT_TRUE(world.run_until([&] { return report.has_value(); }, seconds(30))) << world.replay();
    return report.value_or(StopReport());
  }

  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  World world{shared_by(leases)};
  std::string told;
};

TEST_F(HazardOfSharing, H35_AnExpiredLeaseStopsItsMotion) {
  const LeaseToken token = lease("anna", kOne);
  EXPECT_EQ(move("anna", token, 1, 1'500'000), Reason::unspecified);
  world.run_for(seconds(9));
  EXPECT_TRUE(world.device().busy(1)) << world.replay();
  world.run_for(seconds(3));
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
  ASSERT_EQ(world.outcomes().size(), 1u);
  EXPECT_EQ(world.outcomes()[0].state, MotionState::stopped);
  EXPECT_EQ(move("anna", token, 1, 100), Reason::lease_lost);
}

TEST_F(HazardOfSharing, H35_AMotionWhoseLeaseEndedWhileItWaited) {
  // The motion runs for 14 s, and its registers must be read afterwards.
  world.controller().execute({{"A:2+P700000", "G:2"}, context("bert", 0)}, world.now(), [](const ExecuteEvent&) {});
  const LeaseToken anna = lease("anna", kOne);
  world.run_for(seconds(1));
  MoveRequest request = move_of(world, {{1, 100}}, true);
  request.context = context("anna", anna);
  request.context.not_after = world.now() + seconds(60);
  world.controller().move(std::move(request), world.now(), [](const Result<Motion>&) {});
  int lines_of_anna = 0;
  world.on_news = [&](const Event& event) {
    const auto* bytes = std::get_if<BytesWritten>(&event);
    lines_of_anna += bytes != nullptr && bytes->who == "anna" ? 1 : 0;
  };
  world.run_for(seconds(20));
  ASSERT_EQ(world.outcomes().size(), 2u) << world.replay();
  EXPECT_EQ(reason_of(world.outcomes()[1]), Reason::lease_lost) << world.replay();
  EXPECT_EQ(lines_of_anna, 0) << "it was begun without the right to\n" << world.replay();
}

TEST_F(HazardOfSharing, H54_ATakeOverWaitsUntilTheAxesAreSeenStationary) {
  const LeaseToken token = lease("anna", kOne);
  EXPECT_EQ(move("anna", token, 1, 1'500'000), Reason::unspecified);
  world.run_for(seconds(1));
  const TimePoint back = world.now() + seconds(15);
  world.wire().set_script([this, back](LineKind, const std::string&) {
    return Scripted{.drop = world.now() < back, .delay = {}, .instead = {}};
  });
  std::optional<bool> busy;
  leases.take_over({.scope = kOne}, "chief", world.now(), [&](const Result<Lease>&) { busy = world.device().busy(1); });
  world.run_for(seconds(14));
  EXPECT_FALSE(busy) << "granted while nobody knows what moves\n" << world.replay();
  EXPECT_TRUE(world.run_until([&] { return busy.has_value(); }, seconds(15))) << world.replay();
  EXPECT_FALSE(busy.value_or(true)) << world.replay();
}

TEST_F(HazardOfSharing, H35_AMotionThatMayFinishFinishes) {
  const LeaseToken token = lease("anna", kOne, AtLoss::finish);
  EXPECT_EQ(move("anna", token, 1, 700'000), Reason::unspecified);
  const Motion motion = outcome_of(world, 1, seconds(60));
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_GT(motion.ended - motion.created, seconds(12));
}

// The lease expires between set and go: the start is never sent, and the setting does not run with another caller's
// start.
TEST_F(HazardOfSharing, H35_ExpiryBetweenSetAndGo) {
  const LeaseToken token = lease("anna", kOne);
  world.run_for(seconds(9));
  MoveRequest request = move_of(world, {{1, 5000}}, true);
  request.context = context("anna", token);
  world.controller().move(std::move(request), world.now(), [](const Result<Motion>&) {});
  run_until_written("MP:");
  world.wire().hold_up(false, seconds(2));
  world.run_for(seconds(5));
  EXPECT_EQ(written(world, "G:"), 0) << world.replay();
  EXPECT_EQ(move("bert", 0, 1, 100), Reason::unspecified);
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(1), 100) << world.replay();
}

// The reply to the set is received when the host wakes, before any timer: the lease has still expired. After 12 s the
// controller may have restarted as well; after a tenth of a second it has not.
TEST_F(HazardOfSharing, H36_NoStartAfterTheHostHasSlept) {
  for (const auto& [before, asleep] :
       {std::pair{milliseconds(1000), milliseconds(12'000)}, {milliseconds(9950), milliseconds(100)}}) {
    moved(world, {{1, 700}});  // a counter other than 0 shows that the controller has not restarted
    const int starts = world.device().starts(1), lines = written(world, "G:"), sets = written(world, "MP:");
    const LeaseToken token = lease("anna", kOne);
    world.run_for(before);
    EXPECT_EQ(move("anna", token, 1, 5000), Reason::unspecified);
    EXPECT_TRUE(world.run_until([&] { return written(world, "MP:") > sets && world.wire().answered(); }, seconds(1)));
    world.sleep_for(asleep);
    world.run_for(seconds(5));
    EXPECT_EQ(written(world, "G:"), lines) << world.replay();
    EXPECT_EQ(world.device().starts(1), starts);
  }
}

TEST_F(HazardOfSharing, H21_ARestartEndsLeases) {
  const LeaseToken token = lease("anna", kOne);
  world.power_cycle();
  EXPECT_TRUE(world.run_until([&] { return world.controller().state().device_epoch == 2; }, seconds(60)));
  EXPECT_EQ(move("anna", token, 1, 100), Reason::lease_lost);
  EXPECT_THAT(told, HasSubstr("restarted"));
}

// A program computed its targets before the controller restarted, and continues without noticing.
TEST_F(HazardOfSharing, H21_WhatWasMeantForAnotherEpoch) {
  const std::uint64_t epoch = world.controller().state().device_epoch;
  for (const bool restarted : {false, true}) {
    if (restarted) {
      world.power_cycle();
      EXPECT_TRUE(world.run_until([&] { return world.controller().state().device_epoch > epoch; }, seconds(60)));
      EXPECT_TRUE(world.run_until_up()) << world.replay();
    }
    const int lines = motion_lines(world, 0);
    MoveRequest request = move_of(world, {{1, 5000}}, false);
    request.context.device_epoch = epoch;
    ExecuteRequest transaction{{"M:2+P10", "G:2"}, world.context("anna")};
    transaction.context.device_epoch = epoch;
    std::vector<Reason> refused;
    world.controller().move(std::move(request), world.now(), [&](const Result<Motion>& motion) {
      if (!motion) refused.push_back(motion.error().reason);
    });
    world.controller().execute(transaction, world.now(), [&](const ExecuteEvent& event) {
      if (event.problem) refused.push_back(event.problem->reason);
    });
    world.run_for(seconds(5));
    EXPECT_EQ(refused, restarted ? std::vector(2, Reason::epoch_passed) : std::vector<Reason>()) << world.replay();
    EXPECT_EQ(motion_lines(world, 0) > lines, !restarted) << world.replay();
  }
}

// A loop requests the next move as soon as the last has ended, with any outcome.
TEST_F(HazardOfSharing, H53_AScanLoopStaysStopped) {
  for (const bool leased : {true, false}) {
    const LeaseToken token = leased ? lease("anna", kOne) : 0;
    bool loops = true;
    world.on_motion = [&](const Motion& motion) {
      if (loops && is_outcome(motion.state)) {
        world.at(world.now(), [&] { move("anna", token, 1, world.device().position(1) > 0 ? -3000 : 3000); });
      }
    };
    move("anna", token, 1, 3000);
    world.run_for(seconds(2));
    ASSERT_GT(world.outcomes().size(), 2u);
    EXPECT_FALSE(stop_by("bert").problem);
    const std::size_t lines = world.wire().commands().size();
    world.run_for(seconds(5));
    EXPECT_EQ(motion_lines(world, lines), 0) << world.replay();
    EXPECT_EQ(move("anna", token, 1, 100), Reason::stopped_by);
    EXPECT_THAT(told, HasSubstr("bert stopped"));
    loops = false;
    ASSERT_FALSE(leases.rearm(token, "anna", world.now()).empty());
    EXPECT_EQ(move("anna", token, 1, 100), Reason::unspecified);
    world.run_for(seconds(2));
    if (leased) {
      EXPECT_TRUE(leases.release(token, world.now()));
    }
  }
}

// The stop comes while the loop computes its next move.
TEST_F(HazardOfSharing, H53_AStopBetweenTwoMovesHoldsToo) {
  const LeaseToken token = lease("anna", kOne);
  EXPECT_EQ(move("anna", token, 1, 1000), Reason::unspecified);
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded);
  world.run_for(milliseconds(500));
  stop_by("bert");
  EXPECT_EQ(move("anna", token, 1, 1000), Reason::stopped_by);
}

// Each caller who requested a stop receives its outcome.
TEST_F(HazardOfSharing, H53_JoinedStopsEachGetTheOutcome) {
  EXPECT_EQ(move("anna", 0, 1, 500'000), Reason::unspecified);
  world.run_for(seconds(1));
  std::vector<StopReport> reports;
  for (const char* who : {"bert", "carl", "dora"}) {
    world.controller().stop({}, context(who, 0), world.now(),
                            [&](const StopReport& report) { reports.push_back(report); });
  }
  world.run_for(seconds(5));
  ASSERT_EQ(reports.size(), 3u);
  for (const StopReport& report : reports) EXPECT_FALSE(report.problem);
  EXPECT_EQ(written(world, "L:"), 1) << world.replay();
}

TEST_F(HazardOfSharing, H06_AnothersHomeFailsAtOnce) {
  const LeaseToken token = lease("anna", kAllAxes);
  (void)token;
  std::optional<Reason> reason;
  world.controller().home({kOne, context("bert", 0)}, world.now(), [&](const Result<Motion>& motion) {
    reason = motion ? Reason::unspecified : motion.error().reason;
  });
  EXPECT_EQ(reason, Reason::lease_held);
}

// Another caller cannot overwrite the prebuffer of a running path, by any command.
TEST_F(HazardOfSharing, H11_NobodyWritesIntoAPathsPrebuffer) {
  const LeaseToken token = lease("anna", AxisSet::of(1) | AxisSet::of(2));
  PathRequest path = line_of(world, 6);
  path.context = context("anna", token);
  world.controller().run_path(std::move(path), world.now(), [](const Result<Motion>&) {});
  world.run_for(milliseconds(300));
  EXPECT_EQ(move("bert", 0, 1, 100), Reason::lease_held);
  std::vector<std::string> heard;
  world.controller().execute({{"MP:1+P100", "G:1"}, context("bert", 0)}, world.now(), [&](const ExecuteEvent& event) {
    if (event.problem) heard.emplace_back(name(event.problem->reason));
  });
  EXPECT_THAT(heard, testing::ElementsAre("LEASE_HELD"));
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
}

// Settings of an axis or of the whole controller need the lease; questions do not.
TEST_F(HazardOfSharing, H52_SettingsNeedTheRightToTheirAxes) {
  const LeaseToken token = lease("anna", kOne);
  const auto execute_by = [&](const std::string& who, LeaseToken with, const std::string& line) {
    std::string came;
    world.controller().execute({{line}, context(who, with)}, world.now(), [&](const ExecuteEvent& event) {
      if (event.kind == ExecuteEvent::Kind::reply) came = event.answer;
      if (event.problem) came = name(event.problem->reason);
    });
    world.run_for(seconds(2));
    return came;
  };
  EXPECT_EQ(execute_by("bert", 0, "D:1S100F1000R100"), "LEASE_HELD");
  EXPECT_EQ(execute_by("bert", 0, "D:2S100F1000R100"), "OK");
  EXPECT_EQ(execute_by("bert", 0, "?:D1"), "S1000F50000R100");
  EXPECT_EQ(execute_by("anna", token, "D:1S100F1000R100"), "OK");
}

// A motion that waited for its turn is withdrawn, and its caller must rearm.
TEST_F(HazardOfSharing, WhoWaitedWhenAnotherStoppedIsHeldBack) {
  EXPECT_EQ(move("anna", 0, 1, 100000), Reason::unspecified);
  EXPECT_EQ(move("bert", 0, 1, 100000), Reason::unspecified);
  run_until_written("G");
  stop_by("carl");
  ASSERT_TRUE(world.run_until([&] { return world.outcomes().size() == 2; }, seconds(20))) << world.replay();
  EXPECT_EQ(move("bert", 0, 1, 1000), Reason::stopped_by);
  EXPECT_EQ(move("anna", 0, 1, 1000), Reason::stopped_by);
  EXPECT_EQ(move("carl", 0, 1, 1000), Reason::unspecified);
}

TEST_F(HazardOfSharing, CancellingAnothersMotionHoldsItsCallerBack) {
  EXPECT_EQ(move("anna", 0, 1, 100000), Reason::unspecified);
  run_until_written("G");
  world.controller().cancel_motion(1, context("bert", 0), world.now(), [](const Result<void>&) {});
  ASSERT_TRUE(world.run_until([&] { return world.outcomes().size() == 1; }, seconds(20))) << world.replay();
  EXPECT_EQ(move("anna", 0, 1, 1000), Reason::stopped_by);
  EXPECT_THAT(told, HasSubstr("bert stopped axis 1"));
}

}  // namespace
}  // namespace axisgate::simulation
