// Hazards of setpoints and completions that a stop, a path or a delay leaves behind. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

Setup reading(std::string_view option, std::string_view value) {
  Setup setup = quiet();
  EXPECT_TRUE(setup.options.set(option, value));
  return setup;
}

int starts(World& world) { return world.device().starts(1) + world.device().starts(2) + world.device().starts(3); }

// Interpretations of L:, which clears the prebuffer, keeps it, or lets it start. The stop ends only when no setpoint
// waits.
class HazardH14 : public testing::TestWithParam<const char*> {
 protected:
  bool kept() const { return std::string_view(GetParam()) == "kept"; }

  // Expects READY and a reading of every prebuffer after the last L: and before the caller receives the outcome.
  static void expect_every_prebuffer_was_asked_for(World& world) {
    const auto& lines = world.wire().commands();
    const auto last_stop =
        std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) { return line.starts_with("L:"); });
    for (const char* question : {"Q:SPC", "?:MP", "?:AP", "?:KP", "?:EP"}) {
      EXPECT_NE(std::find(lines.rbegin(), last_stop, question), last_stop) << question << "\n" << world.replay();
    }
  }
};

TEST_P(HazardH14, StoppedWithASegmentInThePrebuffer) {
  for (int after = 0; after < 200 && !HasFailure(); after += 13) {
    World world(reading("stop_keeps_prebuffer", GetParam()));
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.controller().run_path(line_of(world, 12), world.now(), [](Result<Motion>) {});
    ASSERT_TRUE(world.run_until([&] { return written(world, "KP:") == 4; }, seconds(5))) << world.replay();
    world.run_for(milliseconds(5 + after));
    ASSERT_TRUE(world.device().busy(1));
    const StopReport report = stopped(world);
    EXPECT_FALSE(world.device().busy(1) || world.device().busy(2)) << after << "\n" << world.replay();
    if (kept() && report.problem) {
      EXPECT_EQ(report.problem->reason, Reason::stale_setpoint) << after << "\n" << world.replay();
    } else {
      EXPECT_FALSE(report.problem) << after << report.problem->message << "\n" << world.replay();
      expect_every_prebuffer_was_asked_for(world);
    }
    const int before = starts(world);
    world.run_for(seconds(5));
    EXPECT_EQ(starts(world), before) << after << "\n" << world.replay();
    EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
    EXPECT_EQ(written(world, "L:E"), 0) << "the motors of others switched off";
    if (!report.problem) {
      moved(world, {{1, 100}});
    } else {
      EXPECT_EQ(refusal_of(world, {{1, 100}}), Reason::stale_setpoint) << world.replay();
      EXPECT_EQ(starts(world), before);
      world.power_cycle();
      ASSERT_TRUE(world.run_until([&] { return world.controller().state().link != LinkState::up; }, seconds(12)));
      ASSERT_TRUE(world.run_until_up()) << world.replay();
      ASSERT_TRUE(world.run_until([&] { return world.controller().state().open_stops.empty(); }, seconds(5)));
      moved(world, {{1, 100}});
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readings, HazardH14, testing::Values("cleared", "kept", "starts_next"));

// The kept segment starts without a command, and would run for three seconds: a second L: stops it.
TEST(Hazard, H14_TheKeptSegmentStarts) {
  World world(reading("stop_keeps_prebuffer", "starts_next"));
  world.device().set_excitation(3, false, world.now());  // the second L: must not name it either
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  PathRequest path = line_of(world, 12);
  for (Segment& segment : path.segments) segment.moves[1].distance = pulses(60'000);
  world.controller().run_path(path, world.now(), [](Result<Motion>) {});
  ASSERT_TRUE(world.run_until([&] { return written(world, "KP:") == 2; }, seconds(5))) << world.replay();
  world.run_for(milliseconds(500));
  const int before = world.device().starts(1);
  const TimePoint asked = world.now();
  EXPECT_FALSE(stopped(world).problem) << world.replay();
  EXPECT_LT(world.now() - asked, seconds(1)) << world.replay();
  EXPECT_EQ(world.device().starts(1), before + 1) << "the reading does not show itself";
  EXPECT_EQ(written(world, "L:"), 2) << world.replay();
  EXPECT_EQ(written(world, "L:A"), 2) << world.replay();
  EXPECT_FALSE(world.device().busy(1));
}

// A setpoint for the next motion differs from a stale setpoint of the stop, and from a setpoint of a motion of other
// axes.
TEST(Hazard, H14_AMoveAskedForRightAfterAStopIsNotHit) {
  for (int apart = 0; apart < 120 && !HasFailure(); apart += 3) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 100}});
    std::optional<StopReport> report;
    world.controller().stop({}, world.context("stopper"), world.now(), [&](const StopReport& told) { report = told; });
    world.run_for(milliseconds(apart));
    move_by(world, {{1, 5000}});
    EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << apart << "\n" << world.replay();
    ASSERT_TRUE(report);
    EXPECT_FALSE(report->problem) << apart << ": " << report->problem->message << "\n" << world.replay();
    EXPECT_EQ(written(world, "L:"), 1) << apart << "\n" << world.replay();
  }
}

TEST(Hazard, H14_AStopOfOneAxisLeavesThePathOfOthers) {
  for (int after = 0; after < 200 && !HasFailure(); after += 7) {
    auto setup = quiet();
    setup.profile.busy_scope = setup.profile.prebuffer_scope = Scope::axis;
    for (const char* option : {"busy_scope", "prebuffer_scope"}) ASSERT_TRUE(setup.options.set(option, "axis"));
    World world(setup);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.controller().run_path(line_of(world, 12), world.now(), [](Result<Motion>) {});
    ASSERT_TRUE(world.run_until([&] { return written(world, "KP:") == 3; }, seconds(5))) << world.replay();
    world.run_for(milliseconds(after));
    std::optional<StopReport> report;
    world.controller().stop(AxisSet::of(3), world.context("stopper"), world.now(),
                            [&](const StopReport& told) { report = told; });
    EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << after << "\n" << world.replay();
    ASSERT_TRUE(report);
    EXPECT_FALSE(report->problem) << after << ": " << report->problem->message << "\n" << world.replay();
    EXPECT_EQ(written(world, "L:"), 1) << after << "\n" << world.replay();
  }
}

// The completion of a stopped axis is up to 190 ms late: the next move neither begins before it nor ends by it.
class HazardH57 : public testing::TestWithParam<const char*> {};

TEST_P(HazardH57, AMoveAskedForRightAfterAStop) {
  for (int late = 0; late < 200 && !HasFailure(); late += 10) {
    World world(reading("completion_after_stop", GetParam()));
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    const bool sent = std::string_view(GetParam()) == "sent";
    std::optional<TimePoint> stands, second_go;
    std::size_t seen_by_then = 0;
    int goes = 0;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (kind == LineKind::command && line.starts_with("G:") && ++goes == 2) {
        second_go = world.now();
        seen_by_then = world.completions().size();
      }
      return {.drop = false, .delay = milliseconds(kind == LineKind::notice && goes == 1 ? late : 0), .instead = {}};
    });
    move_by(world, {{1, 500'000}});
    world.run_for(milliseconds(500));
    world.controller().stop({}, world.context("stopper"), world.now(), [](const StopReport&) {});
    move_by(world, {{1, -300}});
    ASSERT_TRUE(world.run_until([&] { return !world.device().busy(1); }, seconds(2)));
    stands = world.now();
    const Motion second = outcome_of(world, 2);
    EXPECT_EQ(world.outcomes()[0].state, MotionState::stopped) << late << "\n" << world.replay();
    EXPECT_EQ(second.state, MotionState::succeeded) << late << "\n" << world.replay();
    ASSERT_TRUE(second_go);
    if (sent) {
      EXPECT_EQ(seen_by_then, 1u) << late << " ms: it began before the number had come\n" << world.replay();
    } else {
      EXPECT_GE(*second_go - *stands, milliseconds(200)) << "it began before the time of the number had passed\n"
                                                         << world.replay();
    }
    ASSERT_EQ(world.completions().size(), sent ? 2u : 1u) << world.replay();
    const bool late_one_taken = sent && world.completions()[0].motion == second.id;
    EXPECT_FALSE(late_one_taken) << late << " ms\n" << world.replay();
    EXPECT_EQ(world.completions().back().motion, second.id) << world.replay();
  }
}

INSTANTIATE_TEST_SUITE_P(Readings, HazardH57, testing::Values("sent", "none"));

// Hazard 4, the opposite case: no completion follows L:, and nothing waits for it for ever.
TEST(Hazard, H04_NoCompletionAfterAStop) {
  World world(reading("completion_after_stop", "none"));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500'000}, {3, -500'000}});
  world.run_for(seconds(1));
  EXPECT_FALSE(stopped(world).problem) << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
  EXPECT_TRUE(world.completions().empty());
  moved(world, {{1, 100}, {3, 100}});
  EXPECT_THAT(execute(world, {"?:BEEP"}), testing::ElementsAre("1")) << "asked in vain";
}

// A completion directly after the answer that put the next segment into the prebuffer: no segment has ended yet.
TEST(Hazard, H56_EarlyCompletionsOfAPath) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::reply || line != "OK_D") return {};
    return {.drop = false, .delay = {}, .instead = "OK_D\r\n1\r\n2\r\n"};
  });
  world.controller().run_path(line_of(world, 12), world.now(), [](Result<Motion>) {});
  const Motion path = outcome_of(world, 1);
  EXPECT_EQ(path.state, MotionState::succeeded) << world.replay();
  EXPECT_GE(written(world, "?:KP"), 11) << "refilled unseen\n" << world.replay();
  EXPECT_EQ(written(world, "KP:"), 12) << world.replay();
  EXPECT_EQ(world.device().starts(2), 12) << world.replay();
  EXPECT_EQ(world.device().position(2), 24000);
}

// Each completion of axis 2 is read as one of axis 1.
TEST(Hazard, H56_MisreadCompletionsOfAPath) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::notice || line != "2") return {};
    return {.drop = false, .delay = {}, .instead = "1\r\n"};
  });
  world.controller().run_path(line_of(world, 12), world.now(), [](Result<Motion>) {});
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().starts(2), 12) << world.replay();
  EXPECT_EQ(world.device().position(2), 24000);
}

// A segment was received and accepted with one digit wrong: the sum is not exact, which is not a success.
TEST(Hazard, H56_TheSumMustBeExact) {
  for (const int wrong : {1, 5, 12}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    int segments = 0;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (kind != LineKind::command || !line.starts_with("KP:") || ++segments != wrong) return {};
      std::string other = line;
      other.replace(other.rfind("+P2000"), 6, "+P2001");
      return {.drop = false, .delay = {}, .instead = other + "\r\n"};
    });
    world.controller().run_path(line_of(world, 12), world.now(), [](Result<Motion>) {});
    EXPECT_NE(outcome_of(world, 1).state, MotionState::succeeded) << wrong << "\n" << world.replay();
    EXPECT_EQ(world.device().position(2), 24001);
  }
}

}  // namespace
}  // namespace axisgate::simulation
