// Tests that a waiting caller gets a turn while others follow one another without a pause.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/shrc203/limits.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::MatchesRegex;

// Result of a request to the world.
struct Answered {
  std::optional<TimePoint> at;
  std::string answer;
  std::optional<Problem> problem;
};
using AnsweredPtr = std::shared_ptr<Answered>;

AnsweredPtr ask(World& world, const std::string& line, Duration limit = seconds(20)) {
  auto answered = std::make_shared<Answered>();
  world.controller().execute({{line}, world.context("rare", limit)}, world.now(),
                             [&world, answered](const ExecuteEvent& event) {
                               if (event.kind == ExecuteEvent::Kind::reply) answered->answer = event.answer;
                               if (event.kind != ExecuteEvent::Kind::ended) return;
                               answered->at = world.now();
                               answered->problem = event.problem;
                             });
  return answered;
}

AnsweredPtr move_rarely(World& world, const Ways& ways, Duration limit) {
  auto answered = std::make_shared<Answered>();
  MoveRequest request = move_of(world, ways, true);
  request.context = world.context("rare", limit);
  world.controller().move(std::move(request), world.now(), [&world, answered](const Result<Motion>& motion) {
    answered->at = world.now();
    if (!motion) answered->problem = motion.error();
  });
  return answered;
}

class Turns : public testing::Test {
 protected:
  void begin(Scope busy_scope = Scope::controller) {
    auto setup = quiet();
    setup.profile.busy_scope = setup.profile.prebuffer_scope = busy_scope;
    world_.emplace(setup);
    ASSERT_TRUE(world().run_until_up()) << world().replay();
  }
  World& world() { return *world_; }

  // Keeps axes busy until `done`: each axis has a motion of "busy" that moves it, and another that waits for the first.
  bool busy_until(const AxisSet axes, const std::function<bool()>& done, Duration limit) {
    const TimePoint until = world().now() + limit;
    while (!done() && world().now() < until) {
      for (const int axis : axes.list()) {
        if (unended(axis) < 2) move_for(world(), "busy", {{axis, way_}});
      }
      world().run_for(milliseconds(1));
    }
    return done();
  }
  // Returns once a motion that could begin waits for the question.
  AnsweredPtr ask_and_keep_motions_out() {
    busy_until(
        AxisSet::of(1), [] { return false; }, milliseconds(300));
    const AnsweredPtr answered = ask(world(), "?:AXIS");
    busy_until(
        AxisSet::of(1), [] { return false; }, kTurnAfter);
    const std::size_t before = ended();
    EXPECT_TRUE(busy_until(
        AxisSet::of(1), [&] { return ended() > before; }, seconds(1)));
    EXPECT_FALSE(answered->at);
    EXPECT_EQ(unended(1), 1);
    return answered;
  }
  int unended(int axis) {
    int count = 0;
    for (const Motion& motion : world().controller().motions()) {
      count += motion.who == "busy" && motion.axes.has(axis) && !is_outcome(motion.state) ? 1 : 0;
    }
    return count;
  }
  std::size_t ended() { return world().outcomes().size(); }

  std::int64_t way_ = 4000;  // a fifth of a second
  std::optional<World> world_;
};

// The question waits for two seconds, then for the end of the running motion, and until no completion of that motion is
// outstanding.
TEST_F(Turns, AQuestionAmidMotionsWithoutAPause) {
  begin();
  const TimePoint asked = world().now() + milliseconds(300);
  ASSERT_FALSE(busy_until(
      AxisSet::of(1), [] { return false; }, milliseconds(300)));
  for (const char* question : {"?:AXIS", "?:BEEP"}) {
    const AnsweredPtr answered = ask(world(), question);
    ASSERT_TRUE(busy_until(
        AxisSet::of(1), [&] { return answered->at.has_value(); }, seconds(25)));
    EXPECT_FALSE(answered->problem) << answered->problem->message << world().replay();
    EXPECT_GE(*answered->at, asked + kTurnAfter);
    EXPECT_LE(*answered->at - asked, 2 * (kTurnAfter + milliseconds(1000))) << world().replay();
  }
  const std::size_t before = ended();
  busy_until(
      AxisSet::of(1), [] { return false; }, seconds(2));
  EXPECT_GE(ended(), before + 4) << "the motions did not continue";
  for (const Motion& motion : world().outcomes()) EXPECT_EQ(motion.state, MotionState::succeeded);
}

// A caller moves without a pause, a second at a time. Sixteen callers ask each question again as soon as they have
// their answer.
TEST_F(Turns, SixteenAskersOfEachQuestionAmidMotionsWithoutAPause) {
  constexpr std::array<const char*, 4> kQuestions = {"?:AXIS", "?:BEEP", "I:", "Q:"};
  begin();
  way_ = 20'000;
  struct Asker {
    const char* question;
    TimePoint asked;
    AnsweredPtr answered;
  };
  std::vector<Asker> askers;
  for (int i = 0; i < 64; ++i) askers.push_back({kQuestions.at(static_cast<std::size_t>(i) % 4), {}, nullptr});
  std::map<std::string, Duration> longest;
  std::map<std::string, int> answers;
  busy_until(
      AxisSet::of(1),
      [&] {
        for (Asker& one : askers) {
          if (one.answered && !one.answered->at) continue;
          if (one.answered) {
            EXPECT_FALSE(one.answered->problem) << one.question << ": " << one.answered->problem->message;
            longest[one.question] = std::max(longest[one.question], *one.answered->at - one.asked);
            ++answers[one.question];
          }
          one.asked = world().now();
          one.answered = ask(world(), one.question);
        }
        return false;
      },
      seconds(60));
  for (const auto& [question, wait] : longest) {
    EXPECT_LE(wait, seconds(5)) << question << world().replay();
    RecordProperty(question, std::to_string(wait / milliseconds(1)) + " ms at most, of " +
                                 std::to_string(answers[question]) + " answers");
  }
  EXPECT_EQ(longest.size(), kQuestions.size());
  EXPECT_GE(ended(), 20u) << "the motions did not continue";
}

TEST_F(Turns, NobodyIsHeldUpByAQuestionThatIsAnsweredSoon) {
  begin();
  for (int i = 0; i < 8; ++i) move_for(world(), "busy", {{1, way_}});
  world().run_for(milliseconds(100));
  const AnsweredPtr answered = ask(world(), "?:AXIS");
  ASSERT_TRUE(world().run_until([&] { return ended() == 8; }, seconds(5))) << world().replay();
  EXPECT_FALSE(answered->at) << "it went between two of them";
  ASSERT_TRUE(world().run_until([&] { return answered->at.has_value(); }, seconds(1))) << world().replay();
}

TEST_F(Turns, APathThatRunsIsNotInterrupted) {
  begin();
  world().controller().run_path(line_of(world(), 40), world().now(), [](Result<Motion>) {});
  world().run_for(milliseconds(200));
  const AnsweredPtr answered = ask(world(), "?:AXIS");
  const auto move = move_rarely(world(), {{1, way_}}, seconds(20));
  ASSERT_TRUE(world().run_until([&] { return ended() == 1; }, seconds(10))) << world().replay();
  EXPECT_EQ(world().outcomes()[0].state, MotionState::succeeded);
  EXPECT_EQ(world().outcomes()[0].underruns, 0);
  ASSERT_TRUE(world().run_until([&] { return ended() == 2; }, seconds(10))) << world().replay();
  EXPECT_LT(*answered->at, *move->at) << "the motion went first";
  EXPECT_EQ(world().outcomes()[1].state, MotionState::succeeded);
}

TEST_F(Turns, AStopDoesNotWaitForAQuestionsTurn) {
  begin();
  const AnsweredPtr answered = ask_and_keep_motions_out();
  const std::size_t first = world().wire().commands().size();
  EXPECT_FALSE(stopped(world(), seconds(2)).problem) << world().replay();
  EXPECT_THAT(world().wire().commands()[first], HasSubstr("L:")) << world().replay();
  EXPECT_EQ(unended(1), 0);
  ASSERT_TRUE(world().run_until([&] { return answered->at.has_value(); }, seconds(2))) << world().replay();
  EXPECT_FALSE(answered->problem);
}

TEST_F(Turns, ALineThatIsLostMeanwhileLeavesNobodyWaiting) {
  begin();
  const AnsweredPtr answered = ask_and_keep_motions_out();
  world().wire().cut(world().now(), seconds(1));
  ASSERT_TRUE(world().run_until([&] { return answered->at.has_value(); }, seconds(5))) << world().replay();
  EXPECT_EQ(answered->problem->reason, Reason::link_down);
  EXPECT_EQ(unended(1), 0);
  ASSERT_TRUE(world().run_until_up()) << world().replay();
  moved(world(), {{1, way_}});
}

TEST_F(Turns, ABarrierMeanwhileHoldsNobodyUpForLonger) {
  begin();
  world().wire().set_script(drop_first(world(), LineKind::reply, "?:AXIS"));
  const AnsweredPtr answered = ask_and_keep_motions_out();
  const TimePoint kept = world().now();
  const std::size_t before = ended();
  ASSERT_TRUE(world().run_until([&] { return ended() > before; }, seconds(5))) << world().replay();
  EXPECT_EQ(world().barriers(), 1u);
  EXPECT_TRUE(answered->problem);
  EXPECT_LE(world().now() - kept, seconds(3)) << world().replay();
  EXPECT_EQ(world().outcomes().back().state, MotionState::succeeded);
}

TEST_F(Turns, TheGatewaysEndDoesNotWaitForOne) {
  begin();
  const AnsweredPtr answered = ask_and_keep_motions_out();
  bool over = false;
  world().controller().wind_down(world().now(), [&](const WindDownReport& report) { over = !report.problem; });
  ASSERT_TRUE(world().run_until([&] { return over; }, seconds(1))) << world().replay();
  EXPECT_EQ(answered->problem->reason, Reason::not_sent);
}

// No question can be answered safely while axis 3 moves for a minute. Motions of the other axes wait for a few seconds
// at most.
TEST_F(Turns, AQuestionThatCannotBeAnsweredSoonHoldsOthersUpForAWhileOnly) {
  begin(Scope::axis);
  move_for(world(), "slow", {{3, 3'000'000}});
  world().run_for(milliseconds(300));
  const AnsweredPtr answered = ask(world(), "?:AXIS");
  TimePoint last = world().now();
  Duration longest{};
  std::size_t before = ended();
  busy_until(
      AxisSet::of(1),
      [&] {
        if (ended() != before) {
          longest = std::max(longest, world().now() - last);
          last = world().now();
          before = ended();
        }
        return answered->at.has_value();
      },
      seconds(25));
  EXPECT_EQ(answered->problem->reason, Reason::completion_outstanding);
  EXPECT_GE(longest, kTurnLimit);
  EXPECT_LE(longest, kTurnLimit + seconds(1)) << world().replay();
  for (const Motion& motion : world().outcomes()) EXPECT_EQ(motion.state, MotionState::succeeded);
}

TEST_F(Turns, AMotionBehindSomebodysEndlessOnes) {
  begin();
  busy_until(
      AxisSet::of(1), [] { return false; }, milliseconds(300));
  const std::size_t before = ended();
  const auto answered = move_rarely(world(), {{2, way_}}, seconds(5));
  ASSERT_TRUE(busy_until(
      AxisSet::of(1), [&] { return answered->at.has_value(); }, seconds(5)));
  EXPECT_FALSE(answered->problem);
  EXPECT_LE(ended(), before + 2) << "more than the one that ran, and one that waited before";
}

TEST_F(Turns, AMotionOfSeveralAxesAmidOthersOfOneEach) {
  begin(Scope::axis);
  busy_until(
      AxisSet::of(1) | AxisSet::of(2) | AxisSet::of(3), [] { return false; }, milliseconds(330));
  const TimePoint asked = world().now();
  const auto answered = move_rarely(world(), {{1, way_}, {2, way_}, {3, way_}}, seconds(10));
  ASSERT_TRUE(busy_until(
      kAllAxes, [&] { return answered->at.has_value(); }, seconds(12)));
  EXPECT_FALSE(answered->problem) << answered->problem->message;
  EXPECT_LE(*answered->at - asked, kTurnAfter + seconds(1)) << world().replay();
}

TEST_F(Turns, WhoseTimeIsOverLearnsWhoWasInside) {
  begin();
  move_for(world(), "unix bert", {{1, 500'000}});
  world().run_for(milliseconds(300));
  const auto answered = move_rarely(world(), {{2, way_}}, seconds(1));
  ASSERT_TRUE(world().run_until([&] { return answered->at.has_value(); }, seconds(5)));
  EXPECT_EQ(answered->problem->reason, Reason::deadline_passed);
  EXPECT_THAT(answered->problem->message,
              MatchesRegex("the time allowed passed before the motion had its turn: axis 1 is in motion 1 \\(move by "
                           "unix bert, [0-9]+ s left\\)"));
}

}  // namespace
}  // namespace axisgate::simulation
