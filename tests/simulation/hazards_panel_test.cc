// Hazards of a person's acts at the device: the front panel, motors switched off. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

// An axis known to be off is not named, so that the first line stops the other axes.
TEST(Hazard, H17_AnAxisWithoutExcitationIsNotNamed) {
  World world(quiet());
  world.device().set_excitation(3, false, world.now());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  const StopReport report = stopped(world);
  EXPECT_FALSE(report.problem) << report.problem->message;
  EXPECT_EQ(written(world, "L:"), 1) << world.replay();
  EXPECT_EQ(written(world, "L:A"), 1) << world.replay();
  ASSERT_EQ(report.axes.size(), 3u);
  EXPECT_TRUE(report.axes[0].named && report.axes[1].named);
  EXPECT_EQ(report.axes[0].wire_reply, "OK");
  EXPECT_FALSE(report.axes[2].named);
  EXPECT_EQ(report.axes[2].wire_reply, "");
  EXPECT_FALSE(world.device().busy(1));
}

// The motor is switched off at the front panel without the gateway's knowledge: L: of all axes is NG, and each axis is
// stopped separately.
TEST(Hazard, H17_AnAxisSwitchedOffAtThePanel) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}, {2, -400000}});
  world.run_for(seconds(1));
  world.device().set_excitation(3, false, world.now());
  const StopReport report = stopped(world);
  EXPECT_EQ(written(world, "L:"), 4) << world.replay();
  ASSERT_EQ(report.axes.size(), 3u);
  for (const auto& axis : report.axes) {
    EXPECT_EQ(axis.wire_reply, axis.axis == 3 ? "NG" : "OK") << axis.axis;
    EXPECT_EQ(axis.ready, true) << axis.axis;
    EXPECT_EQ(axis.position_pulses, world.device().position(axis.axis)) << axis.axis;
  }
  EXPECT_FALSE(world.device().busy(1) || world.device().busy(2));
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
}

// The same under the other interpretation of the manual: L: of all axes stops those that it can.
TEST(Hazard, H17_AnAxisSwitchedOffWhereTheOthersStop) {
  auto setup = quiet();
  ASSERT_TRUE(setup.options.set("stop_with_unexcited_axis", "stops_excited"));
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  world.device().set_excitation(3, false, world.now());
  const StopReport report = stopped(world);
  EXPECT_FALSE(report.problem) << report.problem->message;
  EXPECT_EQ(written(world, "L:"), 1) << world.replay();
  for (const auto& axis : report.axes) {
    EXPECT_EQ(axis.wire_reply, "OK");
    EXPECT_EQ(axis.ready, true);
    EXPECT_EQ(axis.position_pulses, world.device().position(axis.axis)) << axis.axis;
  }
  EXPECT_FALSE(world.device().busy(1));
}

// NG from every axis while one moves is reported as such, not as a stop.
TEST(Hazard, H17_AStopThatIsRefusedThroughout) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 1'500'000}});
  world.run_for(seconds(1));
  world.wire().set_script([](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::command || !line.starts_with("L:")) return {};
    return {.drop = false, .delay = {}, .instead = "L:9\r\n"};
  });
  const StopReport report = stopped(world);
  ASSERT_TRUE(world.device().busy(1));
  ASSERT_TRUE(report.problem) << "an optimistic stop\n" << world.replay();
  ASSERT_EQ(report.axes.size(), 3u);
  EXPECT_EQ(report.axes[0].wire_reply, "NG");
  EXPECT_EQ(report.axes[0].ready, false);
}

// The moving axis itself loses its motor, which is a failure.
TEST(Hazard, H17_TheMovingAxisIsSwitchedOff) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  world.device().set_excitation(1, false, world.now());
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::failed) << world.replay();
  move_by(world, {{1, 10}});
  EXPECT_EQ(reason_of(outcome_of(world, 2)), Reason::not_excited) << world.replay();
}

// The gateway asks why the axis has stopped only after a reading that made sense.
TEST(Hazard, H17_AnUnreadablePositionAsksForNoReason) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  int asked = 0, stationary = 0;
  world.on_news = [&asked](const Event& event) {
    const auto* ended = std::get_if<ExchangeEnded>(&event);
    if (ended != nullptr && ended->line == "?:C" && ended->who == "tester") ++asked;  // the gateway also polls it
  };
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::reply || line.find(",R,R,R") == line.npos) return {};
    return {.drop = ++stationary == 2, .delay = {}, .instead = {}};
  });
  world.device().set_excitation(1, false, world.now());
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::failed) << world.replay();
  EXPECT_GT(stationary, 2);
  EXPECT_EQ(asked, 1) << world.replay();
}

struct Panel {
  const char* mode;
  const char* format;
};
void PrintTo(const Panel& panel, std::ostream* out) { *out << panel.mode << " " << panel.format; }

class HazardH19 : public testing::TestWithParam<Panel> {
 protected:
  void leave(World& world) {
    world.device().set_mode(GetParam().mode, world.now());
    world.device().set_format(GetParam().format, world.now());
  }

  // Reports whether no earlier reading is shown as the present state.
  static bool telemetry_is_void(World& world) {
    const State& state = world.controller().state();
    for (const AxisState& axis : state.axes) {
      if (axis.position_pulses || axis.busy) return false;
    }
    return state.link != LinkState::up;
  }

  void expect_it_stays_out(World& world) {
    const std::size_t first = world.wire().commands().size(), outcomes = world.outcomes().size();
    for (int i = 0; i < 20; ++i) {
      move_by(world, {{2, 100}});
      home(world, AxisSet::of(3));
      world.run_for(milliseconds(700));
      EXPECT_TRUE(telemetry_is_void(world)) << world.replay();
    }
    EXPECT_EQ(world.outcomes().size(), outcomes + 40) << world.replay();
    for (std::size_t i = outcomes; i < world.outcomes().size(); ++i) {
      EXPECT_EQ(world.outcomes()[i].state, MotionState::failed);
      ASSERT_TRUE(world.outcomes()[i].problem);
    }
    const std::string why = std::string_view(GetParam().mode) == "HOST" ? GetParam().format : GetParam().mode;
    EXPECT_THAT(world.outcomes().back().problem->message, HasSubstr(why));
    EXPECT_EQ(motion_lines(world, first), 0) << world.replay();
    EXPECT_EQ(written(world, "MODE:") + written(world, "FMT:"), 0) << "switched by the gateway";
  }

  void come_back(World& world) {
    const std::uint64_t epoch = world.controller().state().device_epoch;
    world.device().set_mode("HOST", world.now());
    world.device().set_format("SHOT_FC", world.now());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    EXPECT_GT(world.controller().state().device_epoch, epoch);
    moved(world, {{2, 100}});
  }
};

TEST_P(HazardH19, LeavesHostAtRest) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 700}});
  world.run_for(seconds(2));
  leave(world);
  const Duration two_polls = 2 * world.controller().profile().idle_poll;
  EXPECT_TRUE(world.run_until([&] { return telemetry_is_void(world); }, two_polls)) << world.replay();
  expect_it_stays_out(world);
  come_back(world);
}

TEST_P(HazardH19, LeavesHostInMidMove) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  leave(world);
  const Duration two_polls = 2 * world.controller().profile().moving_poll;
  EXPECT_TRUE(world.run_until([&] { return telemetry_is_void(world); }, two_polls)) << world.replay();
  EXPECT_TRUE(world.controller().state().moving_unknown) << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::unknown) << world.replay();
  expect_it_stays_out(world);
  come_back(world);
  EXPECT_FALSE(world.controller().state().moving_unknown);
  EXPECT_EQ(world.controller().state().axis(1).position_pulses, world.device().position(1));
}

INSTANTIATE_TEST_SUITE_P(FrontPanel, HazardH19,
                         testing::Values(Panel{"MANUAL", "SHOT_FC"}, Panel{"REMOTE", "SHOT_FC"}, Panel{"HOST", "HIT"},
                                         Panel{"EDIT", "HIT"}));

// Foreign motions that a test receives.
struct ForeignMotions : EventSink {
  void on_event(const Event& event, TimePoint) override {
    if (const auto* motion = std::get_if<ForeignMotion>(&event)) told.push_back(motion->axes);
  }
  std::vector<AxisSet> told;
};

// The previous gateway started the motion, and was killed: the motion is reported, not stopped and not continued.
TEST(Hazard, H30_AGatewayThatStartsUnderAMotion) {
  auto setup = quiet();
  ForeignMotions foreign;
  setup.listener = &foreign;
  World world(setup);
  world.wire().cut(world.now(), seconds(1));
  for (const char* line : {"M:2+P300000\r\n", "G:2\r\n"}) world.device().receive(line, world.now());
  ASSERT_TRUE(world.run_until([&] { return !foreign.told.empty(); }, seconds(10))) << world.replay();
  EXPECT_EQ(foreign.told, std::vector{AxisSet::of(2)});
  EXPECT_TRUE(world.controller().state().axis(2).foreign_motion);
  EXPECT_TRUE(world.device().busy(2)) << world.replay();
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_FALSE(world.controller().state().axis(2).foreign_motion);
  EXPECT_EQ(world.device().position(2), 300'000) << world.replay();
  EXPECT_EQ(written(world, "L:"), 0);
  EXPECT_EQ(motion_lines(world, 0), 0);
}

// The gateway's own motion is not foreign, however it ends.
TEST(Hazard, H30_OnesOwnMotionIsNone) {
  auto setup = quiet();
  ForeignMotions foreign;
  setup.listener = &foreign;
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  moved(world, {{1, 30'000}, {3, 20'000}});
  move_by(world, {{1, 500'000}});
  world.run_for(seconds(1));
  stopped(world);
  move_by(world, {{1, 100'000}});
  world.run_for(seconds(1));
  world.wire().cut(world.now(), milliseconds(300));
  world.run_for(seconds(10));
  EXPECT_TRUE(foreign.told.empty()) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
