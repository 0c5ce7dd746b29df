// Hazards of stops that stay open, one guard each, and of the latch of an emergency stop. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "server/access/leases.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

constexpr std::int64_t kFar = 1'900'000;  // pulses: 38 s at F = 50,000

class HazardOfOpenStops : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, kFar}});
    world.run_for(seconds(1));
    ASSERT_TRUE(world.device().busy(1)) << world.replay();
  }

  // Loses all lines for `time`, while the port stays open.
  void lose_all_for(Duration time) {
    const TimePoint until = world.now() + time;
    world.wire().set_script([this, until](LineKind, const std::string&) {
      return Scripted{.drop = world.now() < until, .delay = {}, .instead = {}};
    });
  }

  std::shared_ptr<std::optional<StopReport>> stop(AxisSet axes = {}, bool emergency = false) {
    auto report = std::make_shared<std::optional<StopReport>>();
    const auto made = [report](const StopReport& told) { *report = told; };
    if (emergency) {
      world.controller().emergency_stop(world.context("bert"), world.now(), made);
    } else {
      world.controller().stop(axes, world.context("bert"), world.now(), made);
    }
    return report;
  }

  std::size_t open() { return world.controller().state().open_stops.size(); }
  bool rests_within(Duration limit) {
    return world.run_until([this] { return !world.device().busy(1); }, limit);
  }
  Reason refusal_of_a_move() { return refusal_of(world, {{1, 100}}); }

  World world{quiet()};
};

TEST_F(HazardOfOpenStops, H54_AStopThatIsLostAgainAndAgain) {
  lose_all_for(milliseconds(2500));
  const auto report = stop();
  ASSERT_TRUE(world.run_until([&] { return report->has_value(); }, seconds(10)));
  EXPECT_TRUE((*report)->stays_open);
  EXPECT_EQ((*report)->problem->reason, Reason::outcome_unknown);
  int lost = 0;
  const TimePoint until = world.now() + milliseconds(2500);
  world.wire().set_script([&, until](LineKind kind, const std::string& line) -> Scripted {
    const bool stop_line = kind == LineKind::command && line.starts_with("L:");
    const bool drop = world.now() < until || (stop_line && lost < 3);
    if (stop_line && world.now() >= until) ++lost;
    return {.drop = drop, .delay = {}, .instead = {}};
  });
  EXPECT_TRUE(rests_within(seconds(15))) << world.replay();
  EXPECT_GE(lost, 3) << world.replay();
  EXPECT_TRUE(world.run_until([this] { return open() == 0; }, seconds(20))) << world.replay();
}

TEST_F(HazardOfOpenStops, H54_ItIsTheFirstLineOfANewPort) {
  (void)stop();
  world.wire().cut(world.now(), seconds(1));
  const std::size_t before = world.wire().commands().size();
  ASSERT_TRUE(world.run_until([&] { return world.wire().commands().size() > before; }, seconds(10)));
  EXPECT_EQ(world.wire().commands()[before], "L:D") << world.replay();
}

TEST_F(HazardOfOpenStops, H54_ItFollowsTheFirstLineThatIsHeard) {
  lose_all_for(milliseconds(2500));
  const TimePoint back = world.now() + milliseconds(2500);
  std::optional<std::size_t> heard;
  TimePoint heard_at{};
  world.on_news = [&](const Event& event) {
    const auto* received = std::get_if<BytesReceived>(&event);
    if (received == nullptr || world.now() < back || heard || received->bytes.back() != '\n') return;
    heard = world.wire().commands().size();
    heard_at = world.now();
  };
  (void)stop();
  ASSERT_TRUE(world.run_until([&] { return heard && world.wire().commands().size() > *heard; }, seconds(10)));
  EXPECT_EQ(world.wire().commands()[*heard], "L:D") << world.replay();
  EXPECT_LT(world.now() - heard_at, milliseconds(10)) << "it waits for no barrier\n" << world.replay();
}

// The first unit may have received nothing. The other unit has received only lines that were written before it
// identified itself.
TEST_F(HazardOfOpenStops, H32_AnotherUnitReceivesNoStop) {
  world.visit_of_another_unit("9999999999", milliseconds(100));
  (void)stop();
  ASSERT_TRUE(world.run_until(
      [this] { return world.controller().state().link_problem.find("may have received") != std::string::npos; },
      seconds(20)))
      << world.controller().state().link_problem;
  const int told = written(world, "L:");
  world.run_for(seconds(20));
  EXPECT_EQ(written(world, "L:"), told) << world.replay();
  EXPECT_EQ(open(), 1u);
  world.return_of_the_unit(milliseconds(100));
  EXPECT_TRUE(world.run_until([this] { return open() == 0; }, seconds(30))) << world.replay();
  EXPECT_TRUE(world.violations().empty()) << world.violations().front();
}

// Loses every L: until one reading, number `which` after the first L:, shows a B as an R. Reports whether the axis
// moves when the stop is confirmed.
bool moves_when_confirmed(int which) {
  World world(quiet());
  EXPECT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, kFar}});
  world.run_for(seconds(1));
  int readings = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind == LineKind::command) {
      return {.drop = line.starts_with("L:") && readings < which, .delay = {}, .instead = {}};
    }
    const bool stopped = written(world, "L:") > 0;
    const bool reading = kind == LineKind::reply && world.wire().commands().back().starts_with("Q:");
    if (!stopped || !reading || ++readings != which) return {};
    std::string other = line;
    if (const auto at = other.find(",B,"); at != std::string::npos) other[at + 1] = 'R';
    return {.drop = false, .delay = {}, .instead = other + "\r\n"};
  });
  std::optional<bool> moves;
  world.on_news = [&](const Event& event) {
    const auto* changed = std::get_if<StopChanged>(&event);
    if (changed != nullptr && changed->stop.state == StopState::confirmed) moves = world.device().busy(1);
  };
  world.controller().stop({}, world.context("bert"), world.now(), [](const StopReport&) {});
  EXPECT_TRUE(world.run_until([&] { return moves.has_value(); }, seconds(60))) << world.replay();
  return moves.value_or(false);
}

TEST(HazardOfStopsInDoubt, H54_OneReadyIsNotEnough) {
  for (int which = 1; which <= 6; ++which) EXPECT_FALSE(moves_when_confirmed(which)) << which;
}

// Positions are no evidence while all axes are at 0; only the answer to a ?:CMD sent before the stop is.
TEST(HazardOfStopsInDoubt, H21_AControllerThatWasFrozenHasNotRestarted) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(2));
  const auto epoch = world.controller().state().device_epoch;
  for (int frozen = 600; frozen <= 1200; frozen += 100) {
    world.wire().hold_up(true, milliseconds(frozen));
    world.run_for(milliseconds(100));
    const auto report = stopped(world);
    EXPECT_FALSE(report.stays_open) << frozen << " ms\n" << world.replay();
    world.run_for(seconds(3));
    EXPECT_EQ(world.controller().state().device_epoch, epoch) << frozen << " ms\n" << world.replay();
  }
}

TEST_F(HazardOfOpenStops, H54_AWiderStopAnswersTheCallersOfANarrowerOne) {
  lose_all_for(milliseconds(2500));
  const auto one = stop(AxisSet::of(1));
  const auto all = stop(kAllAxes);
  const auto again = stop(AxisSet::of(2));
  EXPECT_EQ(open(), 1u);
  const auto emergency = stop({}, true);
  const auto later = stop(AxisSet::of(1));
  ASSERT_EQ(open(), 1u);
  EXPECT_EQ(world.controller().state().open_stops.front().kind, StopKind::emergency);
  ASSERT_TRUE(world.run_until([&] { return *one && *all && *again && *emergency && *later; }, seconds(20)));
  ASSERT_EQ((*one)->axes.size(), 1u);
  EXPECT_EQ((*one)->axes.front().axis, 1);
  EXPECT_EQ((*emergency)->axes.size(), 3u);
  EXPECT_TRUE(rests_within(seconds(20))) << world.replay();
  EXPECT_TRUE(world.run_until([this] { return open() == 0; }, seconds(20))) << world.replay();
}

// The controller accepts no stop at all: the stop stays open on a link that is up.
TEST_F(HazardOfOpenStops, H54_MotionIsRefusedWhileAStopIsLate) {
  world.wire().set_script([](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::command || !line.starts_with("L:")) return {};
    return {.drop = false, .delay = {}, .instead = "?:CMD\r\n"};
  });
  const auto report = stop();
  ASSERT_TRUE(world.run_until([&] { return report->has_value(); }, seconds(20))) << world.replay();
  EXPECT_TRUE((*report)->stays_open);
  EXPECT_EQ(refusal_of_a_move(), Reason::stop_unconfirmed) << world.replay();
  const StopId id = world.controller().state().open_stops.front().id;
  bool withdrawn = false;
  world.controller().withdraw_stop(id, world.context("admin"), world.now(),
                                   [&](const Result<void>& done) { withdrawn = done.has_value(); });
  EXPECT_TRUE(withdrawn);
  EXPECT_EQ(open(), 0u);
  world.wire().set_script({});
  EXPECT_FALSE(stopped(world).stays_open);
  moved(world, {{1, 100}});
}

// The motion has ended UNKNOWN, and its axis still runs.
TEST_F(HazardOfOpenStops, H31_AMotionThatEndedUnknownIsStillCancelled) {
  lose_all_for(seconds(4));
  ASSERT_EQ(outcome_of(world, 1).state, MotionState::unknown) << world.replay();
  std::optional<Result<void>> cancelled;
  world.controller().cancel_motion(1, world.context("bert"), world.now(),
                                   [&](Result<void> done) { cancelled = std::move(done); });
  EXPECT_TRUE(rests_within(seconds(12))) << world.replay();
  ASSERT_TRUE(cancelled);
  EXPECT_FALSE(cancelled->has_value()) << "nobody had seen it stop";
}

TEST_F(HazardOfOpenStops, H18_InAModeThatTakesNoStopItWaitsForHost) {
  world.device().set_mode("MANUAL", world.now());
  world.run_for(seconds(3));
  const int before = written(world, "L:");
  const auto report = stop();
  world.run_for(milliseconds(10));
  ASSERT_TRUE(report->has_value()) << "not answered at once";
  EXPECT_TRUE((*report)->stays_open);
  EXPECT_EQ((*report)->problem->reason, Reason::wrong_mode);
  world.run_for(seconds(3));
  EXPECT_EQ(written(world, "L:"), before) << world.replay();
  ASSERT_TRUE(world.device().busy(1));
  world.device().set_mode("HOST", world.now());
  EXPECT_TRUE(rests_within(seconds(3))) << world.replay();
  EXPECT_TRUE(world.run_until([this] { return open() == 0; }, seconds(20))) << world.replay();
}

// When the answer says that the axis is stationary, the motion must have its outcome and its axes must be free.
TEST(StopAndMotion, AgreeAThousandTimes) {
  server::LeaseTokens tokens(1);
  server::Leases leases(tokens);
  auto setup = quiet();
  setup.permission = &leases;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int disagreements = 0;
  for (int i = 0; i < 1000 && !testing::Test::HasFailure(); ++i) {
    RequestContext context = world.context("anna");
    MoveRequest request = move_of(world, {{1, i % 2 == 0 ? kFar : -kFar}}, true);
    if (i % 3 == 0) request.moves[0].profile = SpeedProfile{pulses(500), pulses(20'000), 50};  // restored afterwards
    request.context = context;
    MotionId id = 0;
    world.controller().move(std::move(request), world.now(), [&](const Result<Motion>& motion) {
      if (motion) id = motion->id;
    });
    world.run_for(milliseconds(5 + i % 400));
    std::optional<bool> free;
    world.controller().stop({}, world.context("anna"), world.now(), [&](const StopReport& report) {
      const auto motion = world.controller().motions().back();
      const bool rests = !report.problem && report.axes.front().ready.value_or(false);
      bool granted = false;
      server::LeaseTerms terms;
      terms.scope = kAllAxes;
      leases.acquire(terms, "carl", false, world.now(), world.now(), [&](const Result<server::Lease>& lease) {
        granted = lease.has_value();
        if (lease) (void)leases.release(lease->token, world.now());
      });
      free = rests && is_outcome(motion.state) && granted;
    });
    ASSERT_TRUE(world.run_until([&] { return free.has_value(); }, seconds(20))) << world.replay();
    disagreements += *free ? 0 : 1;
    leases.rearm(0, "anna", world.now());
  }
  EXPECT_EQ(disagreements, 0) << world.replay();
}

class EmergencyLatch : public HazardOfOpenStops {
 protected:
  std::optional<Reason> clear(AxisSet axes) {
    std::optional<Reason> reason;
    world.controller().clear_errors(axes, world.context("admin"), world.now(), [&](const Result<void>& done) {
      reason = done ? Reason::unspecified : done.error().reason;
    });
    world.run_until([&] { return reason.has_value(); }, seconds(30));
    return reason;
  }
};

TEST_F(EmergencyLatch, H20_ItHoldsWhateverBecameOfTheStop) {
  world.wire().set_script([](LineKind kind, const std::string& line) {
    return Scripted{.drop = kind == LineKind::command && line == "L:E", .delay = {}, .instead = {}};
  });
  (void)stop({}, true);
  ASSERT_TRUE(world.controller().state().emergency);
  EXPECT_EQ(refusal_of_a_move(), Reason::emergency_stopped);
  EXPECT_THAT(execute(world, {"M:2+P100", "G:2"}), ElementsAre("EMERGENCY_STOPPED"));
  EXPECT_EQ(clear(kAllAxes), Reason::stop_unconfirmed) << world.replay();
  world.wire().set_script({});
  ASSERT_TRUE(world.run_until([this] { return open() == 0; }, seconds(30))) << world.replay();
  EXPECT_EQ(refusal_of_a_move(), Reason::emergency_stopped);
  world.power_cycle();
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_EQ(refusal_of_a_move(), Reason::emergency_stopped) << "a restart of the controller has lifted it";
}

TEST_F(EmergencyLatch, H20_OnlyClearingAllAxesLiftsIt) {
  const auto report = stop({}, true);
  ASSERT_TRUE(world.run_until([&] { return report->has_value() && open() == 0; }, seconds(30)));
  EXPECT_EQ(clear(AxisSet::of(1)), Reason::unspecified);
  EXPECT_EQ(refusal_of_a_move(), Reason::emergency_stopped);
  world.wire().set_script(drop_first(world, LineKind::reply, "BEC:"));
  EXPECT_NE(clear(kAllAxes), Reason::unspecified);
  EXPECT_EQ(refusal_of_a_move(), Reason::emergency_stopped) << "lifted without an answer to BEC:";
  EXPECT_EQ(clear(kAllAxes), Reason::unspecified);
  EXPECT_FALSE(world.controller().state().emergency);
  EXPECT_THAT(execute(world, {"C:D1"}), ElementsAre("OK"));
  moved(world, {{1, 100}});
}

}  // namespace
}  // namespace axisgate::simulation
