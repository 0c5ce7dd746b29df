// Hazards of a controller that restarts: earlier knowledge of it is void, even if the restart was not seen. The numbers
// are those of device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::shrc203::simulator {
void PrintTo(const Boot& boot, std::ostream* out) { *out << boot.mode << " " << boot.format; }
}  // namespace axisgate::shrc203::simulator

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using simulator::Boot;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Silences from a restart too short to lose a poll up to a restart that loses three probes.
constexpr Duration kSilences[] = {milliseconds(200), milliseconds(350),  milliseconds(600),
                                  milliseconds(900), milliseconds(1400), seconds(3)};
// Within this time even an idle line has been polled twice, a barrier has ended and the handshake too.
constexpr Duration kNoticed = seconds(12);

void restart(World& world, const Boot& boot) {
  world.device().set_boot(boot);
  world.power_cycle(boot.silence);
}

void restart(World& world, Duration silence) { restart(world, Boot{"HOST", "SHOT_FC", silence}); }

bool any_homed(World& world) {
  bool homed = false;
  for (int axis = 1; axis <= kAxisCount; ++axis) homed = homed || world.controller().state().axis(axis).homed;
  return homed;
}

void expect_new_epoch(World& world, std::uint64_t epoch) {
  EXPECT_TRUE(world.run_until([&] { return world.controller().state().device_epoch > epoch; }, kNoticed))
      << "the restart was not noticed\n"
      << world.replay();
  EXPECT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_FALSE(any_homed(world)) << world.replay();
}

class HazardH21 : public testing::TestWithParam<Duration> {};

// Restarts the controller at any time between two polls, while axis 1 is stationary at `place` in the frame of its
// origin.
void restart_at_rest(Duration silence, std::int64_t place, bool stop_follows) {
  for (int phase = 0; phase < 1200 && !testing::Test::HasFailure(); phase += 110) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    home(world, kAllAxes);
    ASSERT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
    if (place != 0) moved(world, {{1, place}});
    world.run_for(milliseconds(1500 + phase));
    ASSERT_TRUE(any_homed(world));
    const std::uint64_t epoch = world.controller().state().device_epoch;
    restart(world, silence);
    if (stop_follows) {
      world.run_for(silence);
      (void)stopped(world);
    }
    expect_new_epoch(world, epoch);
    ASSERT_FALSE(testing::Test::HasFailure()) << phase << " ms after a poll";
  }
}

TEST_P(HazardH21, AtRestAwayFromTheOrigin) { restart_at_rest(GetParam(), 4000, false); }
TEST_P(HazardH21, AtRestAtTheOrigin) { restart_at_rest(GetParam(), 0, false); }
// The stop becomes the answer to ?:CMD, which must not hide the restart before it.
TEST_P(HazardH21, AtRestAndAStopIsTheFirstLineAfterIt) { restart_at_rest(GetParam(), 0, true); }

// An origin return ends at 0, like a restart.
TEST_P(HazardH21, InTheMiddleOfAnOriginReturn) {
  for (int after = 20; after < 900 && !HasFailure(); after += 70) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 20000}});
    const std::uint64_t epoch = world.controller().state().device_epoch;
    home(world, AxisSet::of(1));
    world.run_for(milliseconds(after));
    if (world.outcomes().size() > 1) break;  // ended before the restart
    restart(world, GetParam());
    EXPECT_NE(outcome_of(world, 2).state, MotionState::succeeded) << after << "\n" << world.replay();
    expect_new_epoch(world, epoch);
    EXPECT_EQ(written(world, "HRT"), 1) << "sent again\n" << world.replay();
  }
}

// A move back to 0 also ends at 0, and so does a path whose sum is 0.
TEST_P(HazardH21, InTheMiddleOfAMoveToZero) {
  for (int after = 20; after < 900 && !HasFailure(); after += 70) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 40000}});
    const std::uint64_t epoch = world.controller().state().device_epoch;
    world.controller().move(move_of(world, {{1, 0}}, false), world.now(), [](Result<Motion>) {});
    world.run_for(milliseconds(after));
    ASSERT_EQ(world.outcomes().size(), 1u);
    restart(world, GetParam());
    EXPECT_NE(outcome_of(world, 2).state, MotionState::succeeded) << after << "\n" << world.replay();
    expect_new_epoch(world, epoch);
  }
}

TEST_P(HazardH21, InTheMiddleOfAPathThatEndsWhereItBegan) {
  for (int after = 60; after < 400 && !HasFailure(); after += 45) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    const std::uint64_t epoch = world.controller().state().device_epoch;
    PathRequest path = line_of(world, 2);
    path.segments.push_back({{{1, pulses(-1000), {}}, {2, pulses(-4000), {}}}, true, pulses(20000), {}});
    world.controller().run_path(path, world.now(), [](Result<Motion>) {});
    world.run_for(milliseconds(after));
    ASSERT_TRUE(world.outcomes().empty());
    restart(world, GetParam());
    EXPECT_NE(outcome_of(world, 1).state, MotionState::succeeded) << after << "\n" << world.replay();
    expect_new_epoch(world, epoch);
  }
}

// A target is a place in the frame at the time of the request.
TEST_P(HazardH21, AMoveAskedForRightAfterIt) {
  for (int phase = 0; phase < 1000 && !HasFailure(); phase += 90) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 4000}});
    world.run_for(milliseconds(1200 + phase));
    const std::uint64_t epoch = world.controller().state().device_epoch;
    restart(world, GetParam());
    world.run_for(GetParam() + milliseconds(1));
    if (world.controller().state().device_epoch > epoch) continue;  // already noticed
    world.controller().move(move_of(world, {{1, 5000}}, false), world.now(), [](Result<Motion>) {});
    EXPECT_EQ(outcome_of(world, 2).state, MotionState::failed) << phase << "\n" << world.replay();
    EXPECT_EQ(world.device().starts(1), 1) << "moved in another frame\n" << world.replay();
    expect_new_epoch(world, epoch);
  }
}

INSTANTIATE_TEST_SUITE_P(Silences, HazardH21, testing::ValuesIn(kSilences));

// Seeds 903823 and 1201942: the controller restarts after an answer that is late. Questions asked then are answered in
// time, after that answer. The answer to one ?:CMD is received when another has been sent.
TEST(Hazard, H21_BehindALateAnswer) {
  for (const auto& [question, delay] : {std::pair{"?:V", milliseconds(450)}, {"?:CMD", milliseconds(800)}}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 4000}});
    const std::uint64_t epoch = world.controller().state().device_epoch;
    bool late = false;
    world.wire().set_script([&, asked = question, delay = delay](LineKind kind, const std::string&) -> Scripted {
      if (late || kind != LineKind::reply || world.wire().commands().back() != asked) return {};
      late = true;
      return {.drop = false, .delay = delay, .instead = {}};
    });
    world.controller().execute({{question}, world.context("asker")}, world.now(), [](const ExecuteEvent&) {});
    ASSERT_TRUE(world.run_until([&] { return late; }, seconds(1)));
    restart(world, milliseconds(200));
    world.controller().move(move_of(world, {{1, 5000}}, false), world.now(), [](Result<Motion>) {});
    EXPECT_EQ(outcome_of(world, 2).state, MotionState::failed) << question << "\n" << world.replay();
    EXPECT_EQ(world.device().starts(1), 1) << "moved in another frame\n" << world.replay();
    expect_new_epoch(world, epoch);
  }
}

// Seed 20000561: after the restart one flipped bit shows axis 1 at 1 instead of 0. The gateway took it for the
// controller without a restart, and a motion that the controller had forgotten SUCCEEDED.
TEST(Hazard, H21_OneDamagedReadingProvesNothing) {
  for (int phase = 0; phase < 1200 && !HasFailure(); phase += 110) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 4000}});
    world.run_for(milliseconds(1500 + phase));
    const std::uint64_t epoch = world.controller().state().device_epoch;
    restart(world, milliseconds(900));
    bool damaged = false;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      const std::size_t zero = line.find("P+0");
      if (damaged || kind != LineKind::reply || world.wire().commands().back() != "Q:SPC" || zero == line.npos)
        return {};
      damaged = true;
      std::string other = line;
      return {.drop = false, .delay = {}, .instead = other.replace(zero, 3, "P+1") + "\r\n"};
    });
    expect_new_epoch(world, epoch);
    EXPECT_TRUE(damaged) << world.replay();
  }
}

// Without a restart no question on a quiet line, at any time, may report one.
TEST(Hazard, H21_NoFalseAlarm) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  home(world, kAllAxes);
  ASSERT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  const std::uint64_t epoch = world.controller().state().device_epoch;
  for (int i = 0; i < 40 && !HasFailure(); ++i) {
    world.run_for(milliseconds(77 * i));
    if (i % 4 == 0) (void)stopped(world);
    if (i % 4 == 1) (void)execute(world, {"?:CMD"});
    if (i % 4 == 2) (void)execute(world, {"K:A+P1+P1", "GC:A"});  // refused: K: needs its G
    if (i % 4 == 3) (void)execute(world, {"C:11"});
    EXPECT_EQ(world.controller().state().device_epoch, epoch) << world.replay();
    EXPECT_EQ(world.controller().state().link, LinkState::up) << world.replay();
  }
  EXPECT_TRUE(any_homed(world));
}

// A lost question is no evidence of a restart while a counter other than 0 is evidence against it.
TEST(Hazard, H21_NoFalseAlarmWhenTheAnswerIsLost) {
  for (const LineKind lost : {LineKind::command, LineKind::reply}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    home(world, kAllAxes);
    ASSERT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
    moved(world, {{1, 10}});
    const std::uint64_t epoch = world.controller().state().device_epoch;
    world.wire().set_script(drop_first(world, lost, "?:CMD"));
    world.run_for(seconds(10));
    EXPECT_EQ(world.barriers(), 1u) << world.replay();
    EXPECT_EQ(world.controller().state().device_epoch, epoch) << world.replay();
    EXPECT_TRUE(any_homed(world));
  }
}

// Hazard 22: the controller comes back in another mode than HOST, or another format than SHOT_FC.
class HazardH22 : public testing::TestWithParam<Boot> {};

TEST_P(HazardH22, NoMotionBeforeTheHandshakeHasPassed) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  home(world, kAllAxes);
  ASSERT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  restart(world, GetParam());
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::unknown) << world.replay();
  const std::size_t first = world.wire().commands().size();
  const int starts = world.device().starts(1);
  for (int i = 0; i < 40; ++i) {
    move_by(world, {{1, 100}});
    home(world, AxisSet::of(2));
    world.run_for(milliseconds(700));
    EXPECT_NE(world.controller().state().link, LinkState::up) << world.replay();
  }
  EXPECT_THAT(world.controller().state().link_problem,
              testing::HasSubstr(GetParam().mode == "HOST" ? GetParam().format : GetParam().mode));
  for (std::size_t i = 2; i < world.outcomes().size(); ++i) {
    EXPECT_EQ(world.outcomes()[i].state, MotionState::failed) << world.replay();
  }
  EXPECT_EQ(motion_lines(world, first), 0) << world.replay();
  EXPECT_EQ(written(world, "MODE:") + written(world, "FMT:"), 0) << "switched by the gateway";
  EXPECT_EQ(world.device().starts(1), starts);
  world.device().set_mode("HOST", world.now());
  world.device().set_format("SHOT_FC", world.now());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_FALSE(any_homed(world));
  world.run_for(seconds(6));  // all waiting callers have been answered
  moved(world, {{1, 100}});
}

INSTANTIATE_TEST_SUITE_P(ComesBackIn, HazardH22,
                         testing::Values(Boot{"MANUAL", "SHOT_FC", seconds(1)}, Boot{"TEACHING", "SHOT_FC", seconds(1)},
                                         Boot{"HOST", "HIT", seconds(1)}, Boot{"MANUAL", "HIT", milliseconds(300)}));

}  // namespace
}  // namespace axisgate::simulation
