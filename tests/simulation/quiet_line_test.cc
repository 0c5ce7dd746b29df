// Tests on a perfect line, where everything works in few exchanges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::seconds;

// Counts the polls of the motors: ?:C itself, not ?:CMD.
int motor_questions(World& world, std::size_t first) {
  return written(world, "?:C", first) - written(world, "?:CMD", first);
}

// An idle poll is ?:CMD, because a pause came before it, then the positions and the motors, and no more.
TEST(QuietLine, ExchangesOfAnIdlePoll) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(5));
  const std::size_t first = world.wire().commands().size();
  world.run_for(seconds(60));
  EXPECT_GE(written(world, "Q:SPC", first), 57) << world.replay();
  EXPECT_GE(motor_questions(world, first), 57) << world.replay();
  EXPECT_LE(world.wire().commands().size() - first, 180u) << world.replay();
}

TEST(QuietLine, HandshakeComesUp) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_EQ(world.controller().state().serial_number, "2106001001");
  EXPECT_EQ(world.controller().state().controllable(), kAllAxes);
}

TEST(QuietLine, HomeThenMoveReachesTheTarget) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  Result<Motion> homed = fail(Reason::internal, "");
  world.controller().home({{}, world.context("tester")}, world.now(), [&](Result<Motion> m) { homed = m; });
  ASSERT_TRUE(world.run_until([&] { return world.outcomes().size() == 1; }, seconds(20))) << world.replay();
  EXPECT_EQ(world.outcomes()[0].state, MotionState::succeeded) << world.replay();
  move_by(world, {{1, 10000}, {2, -2500}});
  ASSERT_TRUE(world.run_until([&] { return world.outcomes().size() == 2; }, seconds(20))) << world.replay();
  EXPECT_EQ(world.outcomes()[1].state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(1), 10000);
  EXPECT_EQ(world.device().position(2), -2500);
  EXPECT_EQ(world.device().starts(1), 2);
}

// While the gateway measures the unit's lag, it rarely asks twice about a move.
TEST(QuietLine, ManyMovesTakeHardlyMoreThanThreeExchangesEach) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  for (int i = 0; i < 8; ++i) moved(world, {{1, 1000}});
  constexpr int kMoves = 40;
  const std::size_t first = world.wire().commands().size();
  const TimePoint begun = world.now();
  for (int i = 0; i < kMoves; ++i) moved(world, {{1, i % 2 ? 1000 : -1000}});
  const double questions = written(world, "Q:SPC", first);
  const double motors = motor_questions(world, first);
  const double all = static_cast<double>(world.wire().commands().size() - first) - motors;
  EXPECT_LE(questions / kMoves, 1.1) << world.replay();
  EXPECT_LE(all / kMoves, 3.1) << world.replay();
  EXPECT_LE(motors, (world.now() - begun) / seconds(1) + 1) << world.replay();
  // 94 ms of ramps, settling, and three exchanges at 38400 baud.
  EXPECT_LE((world.now() - begun) / kMoves, std::chrono::milliseconds(160)) << world.replay();
}

TEST(QuietLine, PathRunsOnTheDoubleBuffer) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  PathRequest path;
  path.context = world.context("tester");
  for (int i = 0; i < 20; ++i) {
    path.segments.push_back({{{1, pulses(i % 2 ? 3000 : -1000), {}}, {2, pulses(1000), {}}}, true, pulses(20000), {}});
  }
  world.controller().run_path(path, world.now(), [](Result<Motion>) {});
  ASSERT_TRUE(world.run_until([&] { return world.outcomes().size() == 1; }, seconds(60))) << world.replay();
  EXPECT_EQ(world.outcomes()[0].state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.outcomes()[0].underruns, 0) << world.replay();
  EXPECT_EQ(world.outcomes()[0].segments_done, 20);
  EXPECT_EQ(world.device().position(2), 20000);
}

TEST(QuietLine, StopEndsAMotion) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  std::optional<StopReport> report;
  world.controller().stop({}, world.context("other"), world.now(), [&](StopReport r) { report = r; });
  ASSERT_TRUE(world.run_until([&] { return report && !world.outcomes().empty(); }, seconds(20))) << world.replay();
  EXPECT_FALSE(report->problem) << report->problem->message << world.replay();
  EXPECT_EQ(world.outcomes()[0].state, MotionState::stopped);
  EXPECT_LT(world.device().position(1), 500000);
}

// Hazard 28: the speeds of one user's motion do not apply to the next user's motion.
TEST(QuietLine, SpeedsDoNotOutliveTheirMotion) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  PathRequest path;
  path.context = world.context("tester");
  for (int i = 0; i < 3; ++i) {
    path.segments.push_back({{{1, pulses(4000), {}}, {2, pulses(1000), {}}}, true, pulses(20000), 50});
  }
  world.controller().run_path(path, world.now(), [](Result<Motion>) {});
  MoveRequest move = move_of(world, {{1, 100}}, true);
  move.moves[0].profile = SpeedProfile{pulses(200), pulses(2000), 30};
  world.controller().move(move, world.now(), [](Result<Motion>) {});
  ASSERT_TRUE(world.run_until([&] { return world.outcomes().size() == 2; }, seconds(20))) << world.replay();
  EXPECT_THAT(execute(world, {"?:D1"}), testing::ElementsAre("S1000F50000R100"));
}

TEST(QuietLine, ExecuteAnswers) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, {"?:C1"}), testing::ElementsAre("1"));
  EXPECT_THAT(execute(world, {"HRT:1"}), testing::ElementsAre("OK", "completion 1"));
  EXPECT_THAT(execute(world, {"M:1+P1000", "G:1"}), testing::ElementsAre("OK", "OK"));
  EXPECT_THAT(execute(world, {"G:1"}), testing::ElementsAre("INCOMPLETE_TRANSACTION"));
  EXPECT_THAT(execute(world, {"MP:2+P100", "G:2"}), testing::ElementsAre("OK", "OK", "completion 2"));
}

// With known registers and an idle line: set, go, and one reading when this unit is READY, by the lag of the move
// before.
TEST(QuietLine, ExchangesOfAMove) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 100}});
  const auto first = static_cast<std::ptrdiff_t>(world.wire().commands().size());
  moved(world, {{1, 100}});
  const std::vector<std::string> lines(world.wire().commands().begin() + first, world.wire().commands().end());
  EXPECT_THAT(lines, testing::ElementsAre("MP:1+P100", "G:1", "Q:SPC"));
}

// Callers who accept a state that is 100 ms old share the question in flight; the others get another one.
TEST(QuietLine, CallersShareAQuestionInFlight) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(5));
  const std::size_t first = world.wire().commands().size();
  int answers = 0;
  const auto ask = [&](Duration max_age) {
    world.controller().refresh(max_age, world.context("anna"), world.now(),
                               [&](const Result<State>& state) { answers += state ? 1 : 0; });
    world.run_for(std::chrono::milliseconds(1));
  };
  for (int i = 0; i < 5; ++i) ask(std::chrono::milliseconds(100));
  EXPECT_EQ(answers, 0);
  world.run_for(std::chrono::milliseconds(50));
  EXPECT_EQ(answers, 5);
  EXPECT_EQ(written(world, "Q:SPC", first), 1) << world.replay();
  ask(Duration::zero());
  ask(Duration::zero());
  world.run_for(std::chrono::milliseconds(50));
  EXPECT_EQ(answers, 7);
  EXPECT_EQ(written(world, "Q:SPC", first), 3) << world.replay();
}

// The gateway does not poll a state that a caller reads often enough.
TEST(QuietLine, ACallersQuestionTakesThePlaceOfAPoll) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(1));
  const std::size_t first = world.wire().commands().size();
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(execute(world, {"Q:SPC"}).size(), 1u);
    world.run_for(std::chrono::milliseconds(100));
  }
  EXPECT_LE(written(world, "Q:SPC", first), 51) << world.replay();  // one may have been due before
  EXPECT_LE(world.now() - world.controller().state().read, std::chrono::milliseconds(200));
}

// A setting of speeds, and the read-back of the result.
TEST(QuietLine, ExchangesOfASpeedSetting) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const auto first = static_cast<std::ptrdiff_t>(world.wire().commands().size());
  EXPECT_THAT(execute(world, {"D:1S2000F20000R200"}), testing::ElementsAre("OK"));
  world.run_for(std::chrono::milliseconds(100));
  const std::vector<std::string> lines(world.wire().commands().begin() + first, world.wire().commands().end());
  EXPECT_THAT(lines, testing::ElementsAre("D:1S2000F20000R200", "?:D"));
  EXPECT_EQ(world.controller().state().axis(1).maximum_speed, 20000);
}

}  // namespace
}  // namespace axisgate::simulation
