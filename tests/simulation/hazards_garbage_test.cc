// Hazards of bytes from a bad line or an unexpected device: late probes, merged lines, NG_I, text that is meant for a
// terminal. The numbers are those of device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AnyOf;
using testing::ElementsAre;
using testing::Not;

// Replaces the first answers to a line that begins with `prefix`.
Script instead_of_answer(World& world, std::string prefix, std::string bytes, int answers = 1) {
  return [&world, prefix, bytes, answers](LineKind kind, const std::string&) mutable -> Scripted {
    if (answers == 0 || kind != LineKind::reply || !world.wire().commands().back().starts_with(prefix)) return {};
    --answers;
    return {.drop = false, .delay = {}, .instead = bytes};
  };
}

// Replaces the first line that begins with `prefix` by the same line with a NUL in it, which is answered by NG_I.
Script with_a_nul(std::string prefix) {
  return [prefix, done = false](LineKind kind, const std::string& line) mutable -> Scripted {
    if (done || kind != LineKind::command || !line.starts_with(prefix)) return {};
    done = true;
    return {.drop = false, .delay = {}, .instead = line.substr(0, 2) + '\0' + line.substr(2) + "\r\n"};
  };
}

// The answer to each probe comes after its time limit: the gateway does not take outstanding answers for those of other
// commands.
TEST(Hazard, H02_OwedAnswersOfProbesAreSwallowed) {
  for (const std::string probe : {"?:CMD", "*IDN?"}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 700}});  // a counter other than 0 shows that the controller has not restarted
    int unexpected = 0;
    world.on_news = [&](const Event& event) { unexpected += std::holds_alternative<UnexpectedLine>(event) ? 1 : 0; };
    bool lost = false, late = false;
    world.wire().set_script([&](LineKind kind, const std::string&) -> Scripted {
      if (kind != LineKind::reply) return {};
      const std::string& asked = world.wire().commands().back();
      if (!lost && asked.starts_with("D:")) return {.drop = lost = true, .delay = {}, .instead = {}};
      if (!lost || late || asked != probe) return {};
      late = true;
      return {.drop = false, .delay = milliseconds(700), .instead = {}};
    });
    EXPECT_THAT(execute(world, {"D:1S100F1000R100"}), ElementsAre("REPLY_TIMED_OUT")) << world.replay();
    ASSERT_TRUE(late);
    EXPECT_EQ(written(world, probe) - (probe == "*IDN?" ? 1 : 0), 2) << "not asked again\n" << world.replay();
    EXPECT_THAT(execute(world, {probe}), Not(ElementsAre("REPLY_TIMED_OUT"))) << world.replay();
    EXPECT_THAT(execute(world, {"?:V"}), ElementsAre("V2.00.000")) << world.replay();
    EXPECT_EQ(unexpected, 0) << world.replay();
    EXPECT_EQ(world.barriers(), 1u);
  }
}

// The barrier is ?:CMD, then *IDN?, then 50 ms of silence, with a stop in the middle.
TEST(Hazard, H02_NothingButAStopBeforeTheBarrierHasPassed) {
  for (int after = 0; after < 620 && !HasFailure(); after += 20) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 700}});
    world.wire().set_script(drop_first(world, LineKind::reply, "C:1"));
    const std::size_t first = world.wire().commands().size();
    world.controller().execute({{"C:11"}, world.context("one")}, world.now(), [](const ExecuteEvent&) {});
    world.controller().execute({{"C:21"}, world.context("two")}, world.now(), [](const ExecuteEvent&) {});
    ASSERT_TRUE(world.run_until([&] { return world.barriers() == 1; }, seconds(1)));
    std::optional<TimePoint> identified;
    world.on_news = [&](const Event& event) {
      const auto* bytes = std::get_if<BytesReceived>(&event);
      if (bytes != nullptr && bytes->bytes.starts_with("SIGMAKOKI")) identified = world.now();
    };
    std::optional<Duration> silence;  // before the first line that is neither a probe nor a stop
    int stops_written = 0;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      const bool probe = line == "?:CMD" || line == "*IDN?", stop = line.starts_with("L:");
      if (kind != LineKind::command || silence || probe) return {};
      if (stop) ++stops_written;
      if (!stop) silence = identified ? world.now() - *identified : Duration::zero();
      return {};
    });
    world.run_for(milliseconds(after / 10));
    const bool stops = after % 40 == 0;
    if (stops) {
      EXPECT_EQ(world.controller().state().link, LinkState::doubtful);
      (void)stopped(world);
    }
    ASSERT_TRUE(world.run_until([&] { return silence && written(world, "C:21", first) == 1; }, seconds(3)))
        << world.replay();
    EXPECT_GE(*silence, milliseconds(50)) << "asked " << after << "\n" << world.replay();
    // A stop is written at once, and again after the first line that is received during the barrier.
    EXPECT_GE(stops_written, stops ? 1 : 0) << world.replay();
    EXPECT_LE(stops_written, stops ? 2 : 0) << world.replay();
    EXPECT_EQ(written(world, "C:11", first), 1) << "sent again\n" << world.replay();
  }
}

TEST(Hazard, H09_LinesThatComeTogether) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(instead_of_answer(world, "?:V", "1\r\nV2.00.000\r\n3\r\n"));
  EXPECT_THAT(execute(world, {"?:V"}), ElementsAre("V2.00.000"));
  EXPECT_EQ(world.completions().size(), 2u) << world.replay();
  EXPECT_EQ(world.barriers(), 0u);
}

// The line end between them is lost: neither answer is taken.
TEST(Hazard, H09_LinesMergedIntoOne) {
  for (const char* merged : {"1V2.00.000\r\n", "V2.00.000OK\r\n", "OKV2.00.000\r\n", "V2.00.0001\n1\r\n"}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.wire().set_script(instead_of_answer(world, "?:N", merged));
    EXPECT_THAT(execute(world, {"?:N"}), ElementsAre("LINE_FAULT")) << merged << world.replay();
    EXPECT_EQ(world.barriers(), 1u);
    EXPECT_THAT(execute(world, {"?:N"}), ElementsAre("SHRC-203"));
  }
}

// A line longer than any answer is not an answer, however it begins. The line after it is read.
TEST(Hazard, H09_AnEndlessLine) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(instead_of_answer(world, "?:V", "V2.00." + std::string(100'000, '0') + "\r\n"));
  EXPECT_THAT(execute(world, {"?:V"}), Not(testing::Contains(testing::StartsWith("V"))));
  EXPECT_GE(world.barriers(), 1u);
  EXPECT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, {"?:V"}), ElementsAre("V2.00.000")) << world.replay();
}

TEST(Hazard, H10_ASettingIsLookedUpBeforeItIsSentAgain) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 10}});  // reads the registers
  const std::size_t first = world.wire().commands().size();
  world.wire().set_script(with_a_nul("MP:"));
  moved(world, {{1, 4000}});
  EXPECT_EQ(world.barriers(), 1u) << world.replay();
  const std::vector<std::string> lines(world.wire().commands().begin() + static_cast<std::ptrdiff_t>(first),
                                       world.wire().commands().begin() + static_cast<std::ptrdiff_t>(first) + 6);
  EXPECT_THAT(lines, ElementsAre("MP:1+P4000", "?:CMD", "*IDN?", "?:MP", "MP:1+P4000", "G:1")) << world.replay();
  EXPECT_EQ(world.device().position(1), 4010);
}

TEST(Hazard, H10_AStartIsNotSentAgain) {
  for (const std::string start : {"G:", "HRT:"}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.wire().set_script(with_a_nul(start));
    if (start == "G:") move_by(world, {{1, 4000}});
    if (start != "G:") home(world, AxisSet::of(1));
    EXPECT_THAT(outcome_of(world, 1).state, AnyOf(MotionState::failed, MotionState::unknown)) << world.replay();
    EXPECT_EQ(world.barriers(), 1u) << world.replay();
    EXPECT_EQ(written(world, start), 1) << world.replay();
    EXPECT_EQ(world.device().starts(1), 0);
  }
}

// The controller accepted the start, and the line changed its OK into NG_I: the axis is seen to move, and to arrive.
TEST(Hazard, H10_ARefusalThatWasNone) {
  for (const std::string start : {"G:", "HRT:"}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 1'000'000}});
    world.wire().set_script(instead_of_answer(world, start, "NG_I\r\n"));
    const std::size_t first = world.wire().commands().size();
    if (start == "G:") move_by(world, {{1, -500'000}});
    if (start != "G:") home(world, AxisSet::of(1));
    EXPECT_EQ(outcome_of(world, 2, seconds(60)).state, MotionState::succeeded) << world.replay();
    EXPECT_EQ(world.barriers(), 1u) << world.replay();
    EXPECT_EQ(written(world, start, first), 1) << "sent again\n" << world.replay();
    EXPECT_EQ(world.device().starts(1), 2);
  }
}

class HazardH42 : public testing::Test {
 protected:
  HazardH42() : world(quiet()) {
    world.on_news = [this](const Event& event) {
      if (const auto* entered = std::get_if<BarrierEntered>(&event)) look_at(entered->why);
      if (const auto* link = std::get_if<LinkChanged>(&event)) look_at(link->why);
      if (const auto* motion = std::get_if<MotionChanged>(&event)) look_at(motion->motion.problem);
      look_at(world.controller().state().link_problem);
    };
  }

  // Checks a text that is written unchanged to a log, a page or a terminal.
  void look_at(const std::string& text) {
    ++texts;
    EXPECT_LT(text.size(), 400u) << text;
    for (const char c : text) EXPECT_TRUE(c >= ' ' && c <= '~') << testing::PrintToString(text);
  }
  void look_at(const std::optional<Problem>& problem) {
    if (!problem) return;
    look_at(problem->message);
    look_at(problem->hint);
  }

  void answer_of(const std::string& question, const std::string& bytes, int answers = 1) {
    world.wire().set_script(instead_of_answer(world, question, bytes + "\r\n", answers));
  }

  // Clears the screen, sets the title, colours the following text, and is long.
  const std::string hostile = "\x1b[2J\x1b]0;owned\x07\xC2\x9B" + std::string("31m") + std::string(180, 'A');
  World world;
  int texts = 0;
};

TEST_F(HazardH42, AsAnAnswer) {
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  answer_of("?:V", hostile);
  int told = 0;
  world.controller().execute({{"?:V"}, world.context("tester")}, world.now(), [&](const ExecuteEvent& event) {
    EXPECT_NE(event.kind, ExecuteEvent::Kind::reply);
    if (event.problem) ++told;
    look_at(event.problem);
  });
  ASSERT_TRUE(world.run_until([&] { return told == 1; }, seconds(5))) << world.replay();
  move_by(world, {{1, 10}});
  answer_of("G:", hostile);
  (void)outcome_of(world, 1);
  EXPECT_GT(texts, 5);
}

// An identity that is read twice alike is believed.
TEST_F(HazardH42, AsTheIdentityAtTheHandshake) {
  answer_of("*IDN?", "SIGMAKOKI," + hostile + ",2106001001,V2.00.000", 2);
  world.run_for(milliseconds(300));
  EXPECT_EQ(world.controller().state().link, LinkState::down);
  EXPECT_THAT(world.controller().state().link_problem, testing::HasSubstr("\\x1B[2J"));
  EXPECT_TRUE(world.run_until_up()) << world.replay();
}

TEST_F(HazardH42, AsTheIdentityInABarrier) {
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(drop_first(world, LineKind::reply, "?:V"));
  (void)execute(world, {"?:V"});  // times out, and leaves the next *IDN? to the next barrier
  answer_of("?:V", "?");
  world.controller().execute({{"?:V"}, world.context("tester")}, world.now(), [](const ExecuteEvent&) {});
  ASSERT_TRUE(world.run_until([&] { return world.barriers() == 2; }, seconds(2))) << world.replay();
  answer_of("*IDN?", "SIGMAKOKI," + hostile + ",2106001001,V2.00.000", 2);
  ASSERT_TRUE(world.run_until([&] { return world.controller().state().link == LinkState::down; }, seconds(2)));
  EXPECT_THAT(world.controller().state().link_problem, testing::HasSubstr("\\x1B[2J"));
}

TEST_F(HazardH42, AsTheLineBefore) {
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(2));
  answer_of("?:CMD", "X:" + hostile);
  world.run_for(seconds(10));
  EXPECT_GT(world.barriers(), 0u);
  EXPECT_TRUE(world.run_until_up()) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
