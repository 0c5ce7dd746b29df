// Hazards of stopping, and requests that are refused before anything is written. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "device/shot/command/status.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

std::size_t place_of(World& world, std::string_view prefix, std::size_t first) {
  const auto& lines = world.wire().commands();
  const auto found = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(),
                                  [&](const std::string& line) { return line.starts_with(prefix); });
  return static_cast<std::size_t>(found - lines.begin());
}

TEST(Hazard, H37_StopAfterAThousandQueuedMoves) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  for (int i = 0; i < 1000; ++i) move_for(world, fmt::format("caller-{}", i % 4), {{1 + i % 3, 500000}});
  EXPECT_GE(world.controller().queued(Lane::motion), 990u);
  world.run_for(milliseconds(500));
  ASSERT_EQ(world.device().starts(1), 1) << world.replay();
  const std::size_t first = world.wire().commands().size();
  const StopReport report = stopped(world);
  EXPECT_FALSE(report.problem) << report.problem->message;
  ASSERT_TRUE(world.run_until([&] { return world.outcomes().size() == 1000; }, seconds(5))) << world.replay();
  for (const Motion& motion : world.outcomes()) ASSERT_EQ(motion.state, MotionState::stopped) << motion.id;
  world.run_for(seconds(30));
  EXPECT_EQ(motion_lines(world, place_of(world, "L:", first)), 0) << world.replay();
  EXPECT_EQ(world.device().starts(1) + world.device().starts(2) + world.device().starts(3), 1);
  EXPECT_FALSE(world.device().busy(1));
}

TEST(Hazard, H37_TheQueueIsBounded) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int full = 0;
  for (int i = 0; i < 1100; ++i) {
    MoveRequest request = move_of(world, {{1, 500000}}, true);
    request.context.who = fmt::format("caller-{}", i % 5);
    world.controller().move(std::move(request), world.now(), [&](const Result<Motion>& motion) {
      if (!motion && motion.error().reason == Reason::queue_full) ++full;
    });
  }
  EXPECT_EQ(full, 1100 - 1 - 1024);
}

// Asks the questions of many callers, no two of which share an exchange.
void ask_for_everything(World& world) {
  const std::vector<std::string> units = {"P", "N", "U", "M", "D"};
  for (int round = 0; round < 40; ++round) {
    for (const auto& unit : units) {
      for (const char* question : {"?:M,", "?:A,", "?:MP,", "?:AP,", "Q:S"}) {
        world.controller().execute({{question + unit}, world.context(fmt::format("caller-{}", round))}, world.now(),
                                   [](const ExecuteEvent&) {});
      }
    }
  }
}

TEST(Hazard, H38_StopBehindAThousandQuestions) {
  for (Duration offset{}; offset < milliseconds(30) && !HasFailure(); offset += microseconds(570)) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 500000}});
    world.run_for(milliseconds(300));
    ask_for_everything(world);
    world.run_for(offset);
    EXPECT_GT(world.controller().queued(Lane::question), 0u);
    const std::size_t first = world.wire().commands().size();
    const TimePoint asked = world.now();
    TimePoint written_at{};
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (kind == LineKind::command && line.starts_with("L:")) written_at = world.now();
      return {};
    });
    EXPECT_FALSE(stopped(world).problem) << world.replay();
    EXPECT_EQ(place_of(world, "L:", first), first) << "something went before the stop\n" << world.replay();
    // The longest exchange that may be ahead: 8 characters out and 64 back at 38400 baud.
    EXPECT_LT(written_at - asked, milliseconds(20));
  }
}

// The receive line fails while the axis moves. At any time after that, a stop is written within the time limit of the
// one exchange that may be ahead of it.
TEST(Hazard, H54_ReceiveLineDead) {
  for (int silent = 0; silent < 12000 && !HasFailure(); silent += 170) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 1'500'000}});
    world.run_for(milliseconds(300));
    ASSERT_TRUE(world.device().busy(1));
    std::optional<TimePoint> written_at;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (kind == LineKind::command && line.starts_with("L:") && !written_at) written_at = world.now();
      return {.drop = kind != LineKind::command, .delay = {}, .instead = {}};
    });
    world.run_for(milliseconds(silent));
    const TimePoint asked = world.now();
    const StopReport report = stopped(world);
    ASSERT_TRUE(written_at) << silent << "\n" << world.replay();
    EXPECT_LE(*written_at - asked, milliseconds(550)) << silent << "\n" << world.replay();
    ASSERT_TRUE(report.problem) << silent << "\n" << world.replay();
    EXPECT_EQ(report.problem->reason, Reason::outcome_unknown) << silent << "\n" << world.replay();
    EXPECT_FALSE(report.axes[0].ready) << "nothing was read, and yet told";
    world.run_for(seconds(2));
    EXPECT_FALSE(world.device().busy(1)) << silent << "\n" << world.replay();
    ASSERT_EQ(world.outcomes().size(), 1u);
    EXPECT_EQ(world.outcomes()[0].state, MotionState::unknown);
  }
}

// The same for an origin return, which is one line: a stop before this line ends the motion.
TEST(Hazard, H35_StopBeforeAnOriginReturn) {
  int kept_back = 0;
  for (Duration offset{}; offset < milliseconds(80) && !HasFailure(); offset += microseconds(410)) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.controller().home({AxisSet::of(1), world.context("tester")}, world.now(), [](Result<Motion>) {});
    world.run_for(offset);
    const bool gone = written(world, "HRT:") > 0;
    const std::size_t at = world.wire().commands().size();
    EXPECT_FALSE(stopped(world).problem) << world.replay();
    EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
    EXPECT_EQ(world.device().starts(1), gone ? 1 : 0) << world.replay();
    EXPECT_EQ(motion_lines(world, at), 0) << world.replay();
    if (!gone) ++kept_back;
  }
  EXPECT_GT(kept_back, 0);
}

// A stop at any instant of set and go: a setpoint that was set is no longer started.
TEST(Hazard, H35_StopBetweenSetAndGo) {
  int cut = 0;
  for (Duration offset{}; offset < milliseconds(80) && !HasFailure(); offset += microseconds(410)) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    const std::size_t first = world.wire().commands().size();
    move_by(world, {{1, 300000}});
    world.run_for(offset);
    const bool set = written(world, "MP:", first) > 0, gone = written(world, "G:", first) > 0;
    const std::size_t at = world.wire().commands().size();
    EXPECT_FALSE(stopped(world).problem) << world.replay();
    EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
    EXPECT_LE(world.device().starts(1), gone ? 1 : 0) << world.replay();
    EXPECT_EQ(motion_lines(world, place_of(world, "L:", at)), 0) << world.replay();
    if (set && !gone) ++cut;
    moved(world, {{1, 120}});
  }
  EXPECT_GT(cut, 5) << "no stop has come between a set and its go";
}

// Design rule 6: if the mode allows no stop, the caller is refused at once.
TEST(Hazard, H18_StopOffHostIsRefusedAtOnce) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.device().set_mode("MANUAL", world.now());
  world.run_for(seconds(5));
  EXPECT_EQ(world.controller().state().mode, "MANUAL");
  std::optional<StopReport> report;
  world.controller().stop({}, world.context("other"), world.now(), [&](StopReport told) { report = told; });
  ASSERT_TRUE(world.run_until([&] { return report.has_value(); }, seconds(3))) << world.replay();
  ASSERT_TRUE(report->problem);
  EXPECT_EQ(report->problem->reason, Reason::wrong_mode) << report->problem->message;
  const auto up = world.controller().check_up();
  ASSERT_FALSE(up);
  EXPECT_EQ(up.error().reason, Reason::wrong_mode) << up.error().message;
  world.device().set_mode("HOST", world.now());
  EXPECT_TRUE(world.run_until_up()) << world.replay();
}

TEST(Hazard, H20_EmergencyStopLatchesUntilCleared) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  bool over = false;
  world.controller().emergency_stop(world.context("other"), world.now(), [&](const StopReport& report) {
    EXPECT_FALSE(report.problem);
    over = true;
  });
  ASSERT_TRUE(world.run_until([&] { return over; }, seconds(10))) << world.replay();
  EXPECT_EQ(written(world, "L:E"), 1);
  EXPECT_FALSE(world.device().busy(1));
  EXPECT_NE(outcome_of(world, 1).state, MotionState::succeeded);

  EXPECT_EQ(refusal_of(world, {{2, 1000}}), Reason::emergency_stopped) << world.replay();
  EXPECT_EQ(world.device().starts(2), 0);

  EXPECT_EQ(world.controller().state().axis(2).excited, false) << "L:E has switched the motors off, and nobody is told";
  world.run_for(seconds(10));
  EXPECT_EQ(written(world, "BEC:"), 0) << "cleared without anybody asking for it\n" << world.replay();

  bool cleared = false;
  std::string cleared_by;
  world.on_news = [&](const Event& event) {
    const auto* ended = std::get_if<ExchangeEnded>(&event);
    if (ended != nullptr && ended->line.starts_with("BEC:")) cleared_by = ended->who;
  };
  world.controller().clear_errors({}, world.context("other"), world.now(),
                                  [&](const Result<void>& done) { cleared = done.has_value(); });
  ASSERT_TRUE(world.run_until([&] { return cleared; }, seconds(10))) << world.replay();
  EXPECT_EQ(written(world, "BEC:"), 1);
  EXPECT_EQ(cleared_by, "other");
  EXPECT_EQ(world.device().starts(1) + world.device().starts(2) + world.device().starts(3), 1) << "it moves by BEC:";
  EXPECT_EQ(world.controller().state().axis(2).excited, false);
  EXPECT_THAT(execute(world, {"C:D1"}), ElementsAre("OK"));
  moved(world, {{2, 1000}});
}

// BEC: does not clear an error that lasts as long as its cause: a failed scale is reported until it works again.
TEST(Hazard, H20_WhatClearingDoesNotClear) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.device().set_error(2, simulator::AxisError::scale, true, world.now());
  world.controller().clear_errors({}, world.context("keeper"), world.now(), [](const Result<void>&) {});
  world.run_for(seconds(1));
  ASSERT_EQ(written(world, "BEC:"), 1);
  EXPECT_TRUE(status_of(world.controller().state().axis(2)).bit(3)) << world.replay();
  move_by(world, {{2, 1000}});
  EXPECT_EQ(reason_of(outcome_of(world, 1)), Reason::device_error) << world.replay();
  EXPECT_EQ(world.device().starts(2), 0);
}

// A failure to read back after the clearing is reported as a problem.
TEST(Hazard, H20_ClearingOnALineThatLosesTheAnswer) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.device().press_emergency(world.now());
  world.wire().set_script(drop_first(world, LineKind::reply, "?:C"));
  std::optional<Result<void>> cleared;
  world.controller().clear_errors({}, world.context("keeper"), world.now(),
                                  [&](Result<void> result) { cleared = std::move(result); });
  ASSERT_TRUE(world.run_until([&] { return cleared.has_value(); }, seconds(10))) << world.replay();
  ASSERT_FALSE(cleared->has_value());
  EXPECT_EQ(cleared->error().reason, Reason::reply_timed_out);
}

class Refusals : public testing::Test {
 protected:
  Refusals() : world(limited()) { EXPECT_TRUE(world.run_until_up()) << world.replay(); }

  // A pulse is 10 nm; axis 1 moves from -1 mm to 1 mm at 0.2 mm/s at most.
  static simulation::Setup limited() {
    auto setup = quiet();
    auto& axis = setup.profile.axes[0];
    axis.travel_minimum = Quantity{{-1, 0}, Unit::millimeters};
    axis.travel_maximum = Quantity{{1, 0}, Unit::millimeters};
    axis.maximum_speed = Quantity{{2, 1}, Unit::millimeters};
    return setup;
  }

  // Returns the reason of the refusal, and expects it at once, with nothing written.
  Reason refused(MoveRequest request) {
    const std::size_t lines = world.wire().commands().size();
    std::optional<Reason> reason;
    request.context = world.context("tester");
    world.controller().move(std::move(request), world.now(), [&](const Result<Motion>& motion) {
      reason = motion ? Reason::unspecified : motion.error().reason;
    });
    EXPECT_TRUE(reason.has_value()) << "not answered at once";
    EXPECT_EQ(world.wire().commands().size(), lines) << world.replay();
    EXPECT_TRUE(world.controller().motions().empty());
    return reason.value_or(Reason::unspecified);
  }

  Reason refused(const std::vector<std::string>& lines_of_exec) {
    const std::size_t lines = world.wire().commands().size();
    std::optional<Reason> reason;
    world.controller().execute({lines_of_exec, world.context("tester")}, world.now(), [&](const ExecuteEvent& event) {
      EXPECT_EQ(event.kind, ExecuteEvent::Kind::ended);
      reason = event.problem ? event.problem->reason : Reason::unspecified;
    });
    EXPECT_TRUE(reason.has_value()) << "not answered at once";
    EXPECT_EQ(world.wire().commands().size(), lines) << world.replay();
    return reason.value_or(Reason::unspecified);
  }

  static MoveRequest to(int axis, Quantity target, bool relative = false) {
    return {{{axis, target, {}}}, relative, {}};
  }

  World world;
};

TEST_F(Refusals, OutsideTheTravelLimits) {
  EXPECT_EQ(refused(to(1, pulses(100001))), Reason::outside_travel);
  EXPECT_EQ(refused(to(1, pulses(-100001))), Reason::outside_travel);
  EXPECT_EQ(refused(to(1, {{-1001, 3}, Unit::millimeters}, true)), Reason::outside_travel);
  EXPECT_EQ(refused(to(2, pulses(1'000'000'000))), Reason::out_of_range);
}

TEST_F(Refusals, OutsideTheTravelLimitsFromWhereAnEarlierMoveEnds) {
  move_by(world, {{1, 90000}});
  move_by(world, {{1, 90000}});  // its start is unknown until the first has ended
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  const Motion second = outcome_of(world, 2);
  EXPECT_EQ(second.state, MotionState::failed);
  EXPECT_EQ(second.problem->reason, Reason::outside_travel);
  EXPECT_EQ(world.device().starts(1), 1);
}

TEST_F(Refusals, TooFast) {
  auto request = to(1, pulses(100));
  request.moves[0].profile = SpeedProfile{pulses(1), pulses(20001), 100};
  EXPECT_EQ(refused(request), Reason::too_fast);
  request.moves[0].profile->maximum = pulses(1'000'001);
  EXPECT_EQ(refused(request), Reason::out_of_range);
}

TEST_F(Refusals, NotRepresentable) {
  EXPECT_EQ(refused(to(1, {{15, 0}, Unit::nanometers})), Reason::not_representable);
  EXPECT_EQ(refused(to(1, {{1, 0}, Unit::degrees})), Reason::unknown_unit);
}

TEST_F(Refusals, UnknownAxis) {
  EXPECT_EQ(refused(to(4, pulses(1))), Reason::unknown_axis);
  EXPECT_EQ(refused(to(0, pulses(1))), Reason::unknown_axis);
  EXPECT_EQ(refused(MoveRequest{}), Reason::invalid_request);
}

TEST_F(Refusals, ExecOfHalfATransaction) {
  EXPECT_EQ(refused({"M:1+P100"}), Reason::incomplete_transaction);
  EXPECT_EQ(refused({"MP:1+P100", "?:MP"}), Reason::incomplete_transaction);
  EXPECT_EQ(refused({"G:1"}), Reason::incomplete_transaction);
  EXPECT_EQ(refused({"G"}), Reason::incomplete_transaction);
  EXPECT_EQ(refused({"G:1", "M:1+P100"}), Reason::incomplete_transaction);
  EXPECT_EQ(refused({"?:V", "L:1"}), Reason::invalid_request);
  EXPECT_EQ(refused(std::vector<std::string>{}), Reason::invalid_request);
}

TEST_F(Refusals, H39_ExecOfLinesThatAreNotOne) {
  for (const std::string& bad : {std::string("?:V\r?:N"), std::string("?:V\n"), std::string("?:V\0", 4),
                                 std::string("M:1+P1\xC2\xB5"), std::string("?:V\x7F"), std::string("")}) {
    EXPECT_EQ(refused({bad}), Reason::malformed_line) << testing::PrintToString(bad);
  }
  EXPECT_EQ(refused({"NONSENSE:1"}), Reason::unknown_command);
}

TEST_F(Refusals, ExecOutsideTheTravelLimitsSetsNothing) {
  EXPECT_THAT(execute(world, {"M:1+P100001", "G:1"}), ElementsAre("OUTSIDE_TRAVEL"));
  EXPECT_THAT(execute(world, {"A:1-M2", "G:1"}), ElementsAre("OUTSIDE_TRAVEL"));
  EXPECT_EQ(motion_lines(world, 0), 0) << world.replay();
}

// The speed setting that a lower cap requires is in flight when the stop comes, and nothing of the motion waits.
TEST(Hazard, H37_AStopWhileSpeedsAreSetForAReturn) {
  auto setup = quiet();
  setup.profile.axes[0].maximum_speed = pulses(20'000);
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 9000}});
  const std::size_t lines = world.wire().commands().size(), before = world.outcomes().size();
  world.wire().set_script([&world](LineKind kind, const std::string&) -> Scripted {
    const bool late = kind == LineKind::reply && world.wire().commands().back().starts_with("D:");
    return {.drop = false, .delay = milliseconds(late ? 60 : 0), .instead = {}};
  });
  world.controller().return_to_origin({AxisSet::of(1), world.context("tester")}, world.now(), [](Result<Motion>) {});
  ASSERT_TRUE(world.run_until([&] { return written(world, "D:", lines) == 1; }, seconds(5))) << world.replay();
  world.controller().stop({}, world.context("tester"), world.now(), [](const StopReport&) {});
  EXPECT_EQ(outcome_of(world, before + 1).state, MotionState::stopped) << world.replay();
  world.run_for(seconds(2));
  EXPECT_EQ(written(world, "ZRT:", lines), 0) << world.replay();
  EXPECT_EQ(world.device().position(1), 9000);
}

}  // namespace
}  // namespace axisgate::simulation
