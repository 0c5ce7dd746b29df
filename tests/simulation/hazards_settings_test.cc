// Hazards of settings that outlive their user. The numbers are those of device/shrc203/HAZARDS.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>

#include "server/access/leases.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using server::Lease;
using server::LeaseToken;
using std::chrono::seconds;

class HazardOfSettings : public testing::Test {
 protected:
  HazardOfSettings() { EXPECT_TRUE(world.run_until_up()) << world.replay(); }

  LeaseToken lease(const std::string& holder, AxisSet axes) {
    LeaseToken token = 0;
    leases.acquire({.scope = axes}, holder, false, world.now(), world.now(),
                   [&](const Result<Lease>& got) { token = got ? got->token : 0; });
    EXPECT_NE(token, 0u);
    return token;
  }
  RequestContext context(const std::string& who, LeaseToken token) {
    RequestContext asked = world.context(who);
    asked.lease = token;
    return asked;
  }
  void set_speeds(const std::string& line, const std::string& who, LeaseToken token) {
    world.controller().execute({{line}, context(who, token)}, world.now(), [](const ExecuteEvent&) {});
    world.run_for(seconds(2));
  }
  // Executes lines that set the whole controller. Returns the problem; nullopt if there is none.
  std::optional<Problem> set(const std::vector<std::string>& lines, const std::string& who, LeaseToken token) {
    std::optional<Problem> problem;
    world.controller().execute({lines, context(who, token)}, world.now(), [&](const ExecuteEvent& event) {
      if (event.kind == ExecuteEvent::Kind::ended) problem = event.problem;
    });
    world.run_for(seconds(2));
    return problem;
  }
  // Moves for a few seconds at a speed given in the request.
  void move_slowly(int axis, const std::string& who, LeaseToken token) {
    MoveRequest request = move_of(world, {{axis, 5000}}, true);
    request.moves[0].profile = SpeedProfile{pulses(200), pulses(2000), 30};
    request.context = context(who, token);
    world.controller().move(request, world.now(), [](const Result<Motion>&) {});
  }

  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  World world{shared_by(leases)};
};

// A lease's holder changes speeds with D:, and the next holder finds the old ones.
TEST_F(HazardOfSettings, H28_SpeedsEndWithTheLease) {
  const LeaseToken anna = lease("anna", kOne);
  world.controller().execute({{"D:1S500F7000R300"}, context("anna", anna)}, world.now(), [](const ExecuteEvent&) {});
  world.run_for(seconds(2));
  ASSERT_EQ(world.device().maximum_speed(1), 7000) << world.replay();
  std::optional<std::int64_t> found;
  leases.acquire({.scope = kOne}, "bert", true, world.now() + seconds(60), world.now(),
                 [&](const Result<Lease>& got) { found = got ? world.device().maximum_speed(1) : 0; });
  world.run_for(seconds(20));
  EXPECT_EQ(found, 50'000) << world.replay();
  EXPECT_EQ(written(world, "D:1S1000F50000R100"), 1) << world.replay();
  EXPECT_EQ(world.controller().state().axis(1).maximum_speed, 50'000);
}

TEST_F(HazardOfSettings, H28_SpeedsSetWithoutALeaseStay) {
  execute(world, {"D:1S500F7000R300"});
  world.run_for(seconds(30));
  EXPECT_EQ(world.device().maximum_speed(1), 7000) << world.replay();
}

// The line is lost while the lease expires: the axis stays held until its speeds have been restored.
TEST_F(HazardOfSettings, H28_SpeedsEndWithTheLeaseWhenTheLineComesBack) {
  const LeaseToken anna = lease("anna", kOne);
  world.controller().execute({{"D:1S500F7000R300"}, context("anna", anna)}, world.now(), [](const ExecuteEvent&) {});
  world.run_for(seconds(2));
  world.wire().set_script([](LineKind, const std::string&) -> Scripted { return {true, {}, {}}; });
  world.run_for(seconds(20));
  world.wire().set_script({});
  EXPECT_FALSE(leases.held().empty());
  ASSERT_TRUE(world.run_until([&] { return leases.held().empty(); }, seconds(60))) << world.replay();
  EXPECT_EQ(world.device().maximum_speed(1), 50'000) << world.replay();
}

// The speeds end with the lease however it ends, even with the end of the daemon.
TEST_F(HazardOfSettings, H52_SpeedsEndWithTheDaemon) {
  const LeaseToken anna = lease("anna", kOne);
  world.controller().execute({{"D:1S500F7000R300"}, context("anna", anna)}, world.now(), [](const ExecuteEvent&) {});
  world.run_for(seconds(2));
  bool ended = false;
  world.controller().wind_down(world.now(), [&](const WindDownReport&) { ended = true; });
  ASSERT_TRUE(world.run_until([&] { return ended; }, seconds(5))) << world.replay();
  EXPECT_EQ(world.device().maximum_speed(1), 50'000) << world.replay();
}

// Users' seed 29876: a D: was sent alone while a path moved its axis, and took the path's speed for the earlier
// setting.
TEST(Hazard, H28_SpeedsSetWhileAPathRuns) {
  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  auto setup = shared_by(leases);
  setup.profile.busy_scope = setup.profile.prebuffer_scope = Scope::axis;
  for (const char* option : {"busy_scope", "prebuffer_scope"}) ASSERT_TRUE(setup.options.set(option, "axis"));
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  LeaseToken token = 0;
  leases.acquire({.scope = kOne}, "anna", false, world.now(), world.now(),
                 [&](const Result<Lease>& got) { token = got ? got->token : 0; });
  PathRequest path;
  path.context = world.context("anna");
  path.context.lease = token;
  for (int i = 0; i < 4; ++i) path.segments.push_back({{{1, pulses(2000), {}}}, true, pulses(4000), {}});
  world.controller().run_path(path, world.now(), [](const Result<Motion>&) {});
  ASSERT_TRUE(world.run_until([&] { return written(world, "MP:") == 3; }, seconds(5))) << world.replay();
  world.controller().execute({{"D:1S500F7000R300"}, path.context}, world.now(), [](const ExecuteEvent&) {});
  world.run_for(seconds(5));
  EXPECT_EQ(world.device().maximum_speed(1), 7000) << world.replay();
  world.run_for(seconds(20));
  EXPECT_EQ(world.device().maximum_speed(1), 50'000) << world.replay();
}

TEST(Hazard, H52_SpeedsStayWhereTheyAreToBeKept) {
  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  auto setup = shared_by(leases);
  setup.profile.settings_at_lease_end = AtLeaseEnd::kept;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  LeaseToken token = 0;
  leases.acquire({.scope = kOne}, "anna", false, world.now(), world.now(),
                 [&](const Result<Lease>& got) { token = got ? got->token : 0; });
  RequestContext asked = world.context("anna");
  asked.lease = token;
  world.controller().execute({{"D:1S500F7000R300"}, asked}, world.now(), [](const ExecuteEvent&) {});
  world.run_for(seconds(30));
  EXPECT_TRUE(leases.held().empty());
  EXPECT_EQ(world.device().maximum_speed(1), 7000) << world.replay();
}

// The line is lost during a motion at its own speed: speeds from before the lease are older than those pending restore.
TEST_F(HazardOfSettings, H28_SpeedsBeforeTheLeaseAreOlderThanThoseOwed) {
  const LeaseToken anna = lease("anna", kOne);
  set_speeds("D:1S500F7000R300", "anna", anna);
  move_slowly(1, "anna", anna);
  world.run_for(seconds(1));
  world.wire().cut(world.now(), seconds(1));
  world.run_for(seconds(30));
  EXPECT_EQ(world.device().maximum_speed(1), 50'000) << world.replay();
  moved(world, {{1, 100}});
  EXPECT_EQ(world.device().maximum_speed(1), 50'000) << world.replay();
}

// The lease ends while another caller's motion delays the restore, and the line is lost meanwhile.
TEST_F(HazardOfSettings, H28_ALossOfTheLineWhileItWaitsItsTurn) {
  const LeaseToken anna = lease("anna", kOne);
  set_speeds("D:1S500F7000R300", "anna", anna);
  move_by(world, {{2, 700'000}});  // 14 s
  world.run_for(seconds(10));
  ASSERT_EQ(world.device().maximum_speed(1), 7000) << world.replay();
  world.wire().cut(world.now(), seconds(1));
  world.run_for(seconds(30));
  EXPECT_EQ(world.device().maximum_speed(1), 50'000) << world.replay();
  EXPECT_TRUE(leases.held().empty());
}

// Outputs and the trigger belong to the controller, so they need a lease of all axes; the next holder finds the old
// ones.
TEST_F(HazardOfSettings, H52_OutputsAndTriggerEndWithTheLease) {
  EXPECT_EQ(set({"O:9", "T:P2P500"}, "boss", 0), std::nullopt) << world.replay();
  const LeaseToken anna = lease("anna", kAllAxes);
  EXPECT_EQ(set({"O:32", "T:E1P+2"}, "anna", anna), std::nullopt) << world.replay();
  EXPECT_EQ(set({"O:1", "T:T100"}, "anna", anna), std::nullopt) << world.replay();
  EXPECT_EQ(world.controller().state().outputs, 1);
  EXPECT_EQ(world.controller().state().trigger, (Trigger{Trigger::Target::timer, 0, 100}));
  std::optional<std::string> found;
  leases.acquire({.scope = kOne}, "bert", true, world.now() + seconds(60), world.now(), [&](const Result<Lease>& got) {
    found = got ? fmt::format("{} {}", world.device().outputs(), world.device().trigger()) : "refused";
  });
  world.run_for(seconds(20));
  EXPECT_EQ(found, "9 0,2,500") << world.replay();
  EXPECT_EQ(world.controller().state().outputs, 9);
  EXPECT_EQ(world.controller().state().trigger, (Trigger{Trigger::Target::drive_pulses, 2, 500}));
}

// At the end of the daemon, outputs are off and the trigger is disarmed again, as before the lease.
TEST_F(HazardOfSettings, H52_ATriggerEndsWithTheDaemon) {
  const LeaseToken anna = lease("anna", kAllAxes);
  EXPECT_EQ(set({"O:5", "T:P1P100"}, "anna", anna), std::nullopt) << world.replay();
  bool ended = false;
  world.controller().wind_down(world.now(), [&](const WindDownReport&) { ended = true; });
  ASSERT_TRUE(world.run_until([&] { return ended; }, seconds(5))) << world.replay();
  EXPECT_EQ(world.device().outputs(), 0) << world.replay();
  EXPECT_EQ(world.device().trigger(), "NS") << world.replay();
}

// The answer to O: is lost, although the command was accepted: the outputs are read and set back.
TEST_F(HazardOfSettings, H52_OutputsWhoseAnswerWasLost) {
  const LeaseToken anna = lease("anna", kAllAxes);
  bool dropped = false;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (dropped || kind != LineKind::reply || line != "OK") return {};
    dropped = true;
    return {true, {}, {}};
  });
  EXPECT_NE(set({"O:32"}, "anna", anna), std::nullopt);
  ASSERT_TRUE(dropped);
  EXPECT_EQ(world.device().outputs(), 32) << world.replay();
  EXPECT_EQ(set({"O:3"}, "anna", anna), std::nullopt) << world.replay();
  world.run_for(seconds(30));
  EXPECT_EQ(world.device().outputs(), 0) << world.replay();
}

// Outputs do not depend on motion, so a shutter can open while the stage moves (manual 96) names no condition).
TEST_F(HazardOfSettings, H52_OutputsWaitForNoMotion) {
  const LeaseToken anna = lease("anna", kAllAxes);
  MoveRequest request = move_of(world, {{1, 500'000}}, true);
  request.context = context("anna", anna);
  world.controller().move(request, world.now(), [](const Result<Motion>&) {});
  world.run_for(seconds(1));
  ASSERT_TRUE(world.device().busy(1)) << world.replay();
  EXPECT_EQ(set({"O:32"}, "anna", anna), std::nullopt) << world.replay();
  EXPECT_EQ(world.device().outputs(), 32) << world.replay();
  EXPECT_TRUE(world.device().busy(1)) << world.replay();
}

// One additional byte in the answer to ?:B gives speeds that no B: can set; they are read again.
TEST(Hazard, H28_OriginSpeedsThatNoAxisCanHave) {
  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  World world(shared_by(leases));
  bool once = false;
  world.wire().set_script([&once](LineKind kind, const std::string& line) -> Scripted {
    if (once || kind != LineKind::reply || !line.starts_with("S5000F500000R100,")) return {};
    once = true;
    return {false, {}, "S5000F5000R100,S5000F500R100,S5000F500000R100\r\n"};
  });
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  LeaseToken token = 0;
  leases.acquire({.scope = AxisSet::of(2)}, "anna", false, world.now(), world.now(),
                 [&](const Result<Lease>& got) { token = got ? got->token : 0; });
  RequestContext asked = world.context("anna");
  asked.lease = token;
  world.controller().execute({{"B:2S100F1000R100"}, asked}, world.now(), [](const ExecuteEvent&) {});
  world.run_for(seconds(30));
  EXPECT_TRUE(once);
  EXPECT_EQ(written(world, "B:2S5000F500000R100"), 1) << world.replay();
}

// Outputs are sent under the lease with which they were requested, or not at all.
TEST_F(HazardOfSettings, H35_OutputsOfALeaseThatEndedAreNotSent) {
  const LeaseToken anna = lease("anna", kAllAxes);
  world.wire().hold_up(true, seconds(1));
  world.controller().execute({{"?:V"}, world.context("bert")}, world.now(), [](const ExecuteEvent&) {});
  std::optional<Problem> problem;
  world.controller().execute({{"O:1"}, context("anna", anna)}, world.now(), [&](const ExecuteEvent& event) {
    if (event.kind == ExecuteEvent::Kind::ended) problem = event.problem;
  });
  EXPECT_TRUE(leases.release(anna, world.now()));
  world.run_for(seconds(30));
  ASSERT_TRUE(problem) << world.replay();
  EXPECT_EQ(written(world, "O:1"), 0) << world.replay();
  EXPECT_EQ(world.device().outputs(), 0) << world.replay();
}

// After a restart of the controller the gateway switches nothing on.
TEST_F(HazardOfSettings, H52_NothingIsSwitchedOnAfterARestart) {
  EXPECT_EQ(set({"O:32", "T:T100"}, "boss", 0), std::nullopt) << world.replay();
  const LeaseToken anna = lease("anna", kAllAxes);
  EXPECT_EQ(set({"O:0", "T:S"}, "anna", anna), std::nullopt) << world.replay();
  world.power_cycle();
  world.run_for(seconds(60));
  EXPECT_EQ(world.device().outputs(), 0) << world.replay();
  EXPECT_EQ(world.device().trigger(), "NS") << world.replay();
  EXPECT_TRUE(leases.held().empty());
}

// A caller's own setting replaces one that is pending restore.
TEST_F(HazardOfSettings, H28_ASettingOfOnesOwnIsNotOverwritten) {
  move_slowly(2, "anna", 0);
  world.run_for(seconds(1));
  world.wire().cut(world.now(), seconds(1));
  world.run_for(seconds(10));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  set_speeds("D:2S500F7000R300", "bert", 0);
  moved(world, {{2, 100}});
  EXPECT_EQ(world.device().maximum_speed(2), 7000) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
