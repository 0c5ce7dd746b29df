// Hazards of the line itself: the assignment of answers to commands. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AnyOf;
using testing::ElementsAre;

struct NumberQuestion {
  const char* line;
  const char* answer;
};

// IN1 and OUT1 are on and W: is 0.1 s, so that most answers are the same digit as a completion of axis 1.
constexpr std::string_view kSetWay = "?:M1";
const NumberQuestion kNumberQuestions[] = {
    {"?:C1", "1"},   {"?:F1", "1"}, {"?:SLEEP", "0"}, {"?:BO", "1"}, {"?:BEEP", "1"}, {"?:AXIS", "6"},
    {"?:ACS1", "0"}, {"?:O", "1"},  {"?:W", "1"},     {"I:", "1"},   {"?:M1", "NS"},
};

void PrintTo(const NumberQuestion& question, std::ostream* out) { *out << question.line; }

class HazardH01 : public testing::TestWithParam<NumberQuestion> {
 protected:
  // Asks at `offset` after `start` has started axis 1. The answer must be right, and the axis number must be seen once.
  void ask_during(World& world, const std::function<void()>& start, Duration offset, const std::string& while_moving) {
    const std::size_t outcomes = world.outcomes().size(), completions = world.completions().size();
    start();
    world.run_for(offset);
    EXPECT_THAT(execute(world, {GetParam().line}), ElementsAre(AnyOf(GetParam().answer, while_moving)))
        << "asked " << offset.count() << " ns after the start\n"
        << world.replay();
    EXPECT_EQ(outcome_of(world, outcomes + 1).state, MotionState::succeeded) << world.replay();
    world.run_for(milliseconds(300));
    EXPECT_EQ(world.completions().size(), completions + 1) << offset.count() << "\n" << world.replay();
  }

  void prepare(World& world) {
    world.device().set_inputs(1);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    foreign_traffic(world, {"O:1", "W:1"});
  }
};

TEST_P(HazardH01, CompletionDuringABareNumberQuestionOfAnOriginReturn) {
  World world(quiet());
  prepare(world);
  const auto home = [&] {
    world.controller().home({AxisSet::of(1), world.context("tester")}, world.now(), [](Result<Motion>) {});
  };
  home();
  ASSERT_EQ(outcome_of(world, 1).state, MotionState::succeeded);
  const Duration lasts = world.outcomes()[0].ended - world.outcomes()[0].created;
  const auto ask_at = [&](Duration offset) { ask_during(world, home, offset, GetParam().answer); };
  for (Duration offset{}; offset < lasts + milliseconds(50) && !HasFailure(); offset += microseconds(1130)) {
    ask_at(offset);
  }
  // Around the completion, byte by byte: 260 us each at 38400 baud.
  for (Duration offset = lasts - milliseconds(80); offset < lasts && !HasFailure(); offset += microseconds(260)) {
    ask_at(offset);
  }
  EXPECT_EQ(world.barriers(), 0u) << world.replay();
}

TEST_P(HazardH01, CompletionDuringABareNumberQuestionOfAMove) {
  World world(quiet());
  prepare(world);
  std::int64_t way = 300;
  const auto move = [&] { move_by(world, {{1, way = -way}}); };
  move();
  ASSERT_EQ(outcome_of(world, 1).state, MotionState::succeeded);
  const auto& first = world.outcomes()[0];
  const Duration lasts = first.ended - first.created;
  for (Duration offset{}; offset < lasts + milliseconds(20) && !HasFailure(); offset += microseconds(730)) {
    // A setpoint can be read while it is executed.
    ask_during(world, move, offset, GetParam().line == kSetWay ? std::to_string(-way) : GetParam().answer);
  }
  EXPECT_EQ(world.barriers(), 0u) << world.replay();
}

INSTANTIATE_TEST_SUITE_P(Questions, HazardH01, testing::ValuesIn(kNumberQuestions));

// Delays the first OK to D: by `delay`, while another caller's command waits. Returns the answers to both, in order.
std::vector<std::string> heard_with_late_ok(World& world, Duration delay) {
  auto delayed = std::make_shared<bool>(false);
  world.wire().set_script([&world, delayed, delay](LineKind kind, const std::string&) -> Scripted {
    if (*delayed || kind != LineKind::reply || !world.wire().commands().back().starts_with("D:")) return {};
    *delayed = true;
    return {.drop = false, .delay = delay, .instead = {}};
  });
  std::vector<std::string> heard;
  const auto hear = [&](const ExecuteEvent& event) {
    if (event.kind == ExecuteEvent::Kind::reply) heard.push_back(event.answer);
    if (event.kind == ExecuteEvent::Kind::ended && event.problem) heard.emplace_back(name(event.problem->reason));
  };
  world.controller().execute({{"D:1S100F1000R100"}, world.context("one")}, world.now(), hear);
  EXPECT_TRUE(world.run_until([&] { return *delayed; }, seconds(1))) << world.replay();
  world.controller().execute({{"C:10"}, world.context("other")}, world.now(), hear);
  EXPECT_TRUE(world.run_until([&] { return heard.size() >= 2; }, seconds(30))) << world.replay();
  world.run_for(seconds(5));
  EXPECT_TRUE(world.violations().empty()) << world.violations().front() << "\n" << world.replay();
  return heard;
}

// Inputs and outputs can be read while a single motion runs, although their answer looks like its completion.
TEST(Hazard, H01_InputsAreReadDuringAMotion) {
  World world(quiet());
  world.device().set_inputs(1);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(milliseconds(500));
  EXPECT_THAT(execute(world, {"I:"}), ElementsAre("1"));
  EXPECT_TRUE(world.outcomes().empty()) << world.replay();
  EXPECT_TRUE(world.completions().empty()) << world.replay();
  EXPECT_TRUE(world.device().busy(1));
}

// Seeds 402359 and 500862: a faulty controller repeats the number of another axis around each of two answers. The last
// flood has one answer alone, and loses the other.
TEST(Hazard, H01_InputsAmidAFloodOfNumbers) {
  const std::vector<std::vector<std::string>> floods = {
      {"3\r\n3\r\n2\r\n3\r\n", "3\r\n2\r\n3\r\n"}, {"3\r\n1\r\n2\r\n", "1\r\n1\r\n2\r\n"}, {"3\r\n", "3\r\n2\r\n"}};
  for (const auto& flood : floods) {
    World world(quiet());
    world.device().set_inputs(2);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 500000}, {2, 500000}, {3, 500000}});
    world.run_for(milliseconds(500));
    std::size_t asked = 0;
    world.wire().set_script([&](LineKind kind, const std::string& text) -> Scripted {
      if (kind != LineKind::reply || text != "2" || asked >= flood.size()) return {};
      return {.drop = false, .delay = {}, .instead = flood[asked++]};
    });
    EXPECT_THAT(execute(world, {"I:"}), ElementsAre("2")) << world.replay();
    EXPECT_EQ(asked, flood.size()) << "the last answers came without others";
    EXPECT_TRUE(world.outcomes().empty()) << world.replay();
  }
}

// Seed 701287: a byte of ZRT:1 is lost, and the controller returns all axes to their origin.
void ask_while_axis_2_returns_unasked(World& world, Duration before_it_stands) {
  world.wire().set_script([](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::command || line != "ZRT:1") return {};
    return {.drop = false, .delay = {}, .instead = "ZRT:\r\n"};
  });
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const auto return_axis_1 = [&] {
    moved(world, {{2, 50000}});
    world.run_for(seconds(1));
    world.controller().return_to_origin({AxisSet::of(1), world.context("tester")}, world.now(), [](Result<Motion>) {});
    return world.now();
  };
  const TimePoint first = return_axis_1();
  ASSERT_TRUE(world.run_until([&] { return world.device().busy(2); }, seconds(1)));
  ASSERT_TRUE(world.run_until([&] { return !world.device().busy(2); }, seconds(5)));
  const Duration lasts = world.now() - first;
  world.run_for(seconds(2));
  return_axis_1();
  world.run_for(lasts - before_it_stands);
  EXPECT_THAT(execute(world, {"?:AXIS"}), ElementsAre("6")) << world.replay();
  EXPECT_TRUE(world.violations().empty()) << world.violations().front() << "\n" << world.replay();
}

TEST(Hazard, H01_CompletionOfAnAxisThatNobodyAskedToMove) {
  for (Duration ahead{}; ahead < milliseconds(120) && !HasFailure(); ahead += milliseconds(1)) {
    World world(quiet());
    ask_while_axis_2_returns_unasked(world, ahead);
  }
}

// OK_D: the setting starts without its G when another axis has ended, and completes while a question sent in between
// waits for its answer, which is lost.
TEST(Hazard, H01_CompletionOfASettingThatChains) {
  int chained = 0;
  for (int ahead = 0; ahead < 60 && !HasFailure(); ++ahead) {
    auto setup = quiet();
    setup.profile.busy_scope = setup.profile.prebuffer_scope = Scope::axis;
    for (const char* option : {"busy_scope", "prebuffer_scope"}) ASSERT_TRUE(setup.options.set(option, "axis"));
    ASSERT_TRUE(setup.options.set("prebuffer_while_other_axis_runs", "chains"));
    World world(setup);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.wire().set_script([&](LineKind kind, const std::string& text) -> Scripted {
      const auto& lines = world.wire().commands();
      if (kind != LineKind::reply) return {};
      chained += text == "OK_D" ? 1 : 0;
      const bool between = lines.back() == "?:SLEEP" && lines[lines.size() - 2].starts_with("MP:1");
      return {.drop = between, .delay = {}, .instead = {}};
    });
    move_by(world, {{3, 5000}});
    world.run_for(milliseconds(150 + ahead));
    move_by(world, {{1, 100}});
    world.run_until([&] { return world.wire().commands().back().starts_with("MP:1"); }, seconds(1));
    world.controller().execute({{"?:SLEEP"}, world.context("other")}, world.now(), [](const ExecuteEvent&) {});
    world.run_for(seconds(3));
    ASSERT_TRUE(world.violations().empty()) << world.violations().front() << "\n" << world.replay();
  }
  EXPECT_GT(chained, 0);
}

TEST(Hazard, H02_OkWithinTheTimeLimit) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(heard_with_late_ok(world, milliseconds(450)), ElementsAre("OK", "OK")) << world.replay();
  EXPECT_EQ(world.barriers(), 0u);
}

// The late OK is received during or after the barrier and belongs to no command; the next command gets its own answer.
TEST(Hazard, H02_LateOkIsNotTheNextCommandsAnswer) {
  for (int delay = 550; delay < 1500 && !HasFailure(); delay += 25) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    EXPECT_THAT(heard_with_late_ok(world, milliseconds(delay)), ElementsAre("REPLY_TIMED_OUT", "OK"))
        << delay << " ms late\n"
        << world.replay();
    // After the line in doubt only the barrier's probes are sent until the last probe has been answered.
    const auto& lines = world.wire().commands();
    const auto doubtful = std::ranges::find(lines, "D:1S100F1000R100");
    const auto next = std::find_if(doubtful + 1, lines.end(),
                                   [](const std::string& line) { return line != "?:CMD" && line != "*IDN?"; });
    EXPECT_EQ(*(next - 1), "*IDN?") << world.replay();
    EXPECT_EQ(std::ranges::count(doubtful, lines.end(), "D:1S100F1000R100"), 1) << "sent twice";
  }
}

// A digit corrupted on the line is not published: a jump that no stage can make is read again.
TEST(Hazard, H08_CorruptedDigitOfAPosition) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int corrupted = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::reply || !line.starts_with("P") || corrupted > 0) return {};
    ++corrupted;
    return {.drop = false, .delay = {}, .instead = "P9000000" + line.substr(line.find(',')) + "\r\n"};
  });
  for (int i = 0; i < 3000; ++i) {
    world.run_for(milliseconds(1));
    ASSERT_EQ(world.controller().state().axis(1).position_pulses, 0) << world.replay();
  }
  EXPECT_EQ(corrupted, 1);
}

// Every line comes in two parts with a pause between them, during a motion of two axes in opposite directions; then a
// line that never ends.
TEST(Hazard, H09_PartialLines) {
  auto setup = quiet();
  setup.faults.split = 1;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 2000}, {3, -700}});
  EXPECT_EQ(world.device().position(3), -700);
  EXPECT_EQ(world.barriers(), 0u) << world.replay();
}

TEST(Hazard, H09_UnterminatedLineIsNeverACompleteOne) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int cut = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::reply || !line.starts_with("V") || cut++ > 0) return {};
    return {.drop = false, .delay = {}, .instead = "V2.00"};
  });
  EXPECT_THAT(execute(world, {"?:V"}), testing::Not(testing::Contains("V2.00")));
  EXPECT_EQ(world.barriers(), 1u);
  EXPECT_THAT(execute(world, {"?:V"}), ElementsAre("V2.00.000"));
}

// One flipped bit makes a speed's S greater than its F. A value that no D: can set is read again.
TEST(Hazard, H08_ASpeedMisreadIsNotPutBack) {
  const std::string misread = "S9000F500R100";  // each within its range, but manual 89) D: requires S below F
  World world(quiet());
  int asked = 0;
  world.wire().set_script([&](LineKind kind, const std::string&) -> Scripted {
    const bool first = kind == LineKind::reply && world.wire().commands().back() == "?:D" && ++asked == 1;
    if (!first) return {};
    return {.drop = false, .delay = {}, .instead = misread + ",S1000F50000R100," + misread + "\r\n"};
  });
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  ASSERT_FALSE(world.controller().state().axis(1).maximum_speed);
  MoveRequest move = move_of(world, {{1, 3000}, {2, 3000}}, true);
  move.moves[1].profile = SpeedProfile{pulses(500), pulses(7000), 70};
  world.controller().move(std::move(move), world.now(), [](Result<Motion>) {});
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.controller().state().axis(1).maximum_speed, 50000);
  EXPECT_EQ(written(world, "MP:"), written(world, "MP:A+P3000+P3000,S1000F50000R100 S500F7000R70")) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
