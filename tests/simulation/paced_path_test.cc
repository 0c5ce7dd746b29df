// Tests of a path of short segments at 38400 baud while sixteen callers ask without a pause. They leave out the
// reservation of the line for refills, and the priority of refills, to show why both are needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/paced/track.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::minutes;

using paced::kCallers;
using paced::kOwnQuestions;
using paced::Track;

// Callers who ask again as soon as they are answered.
class Pollers {
 public:
  enum class Asks { status, own_question };

  Pollers(World& world, Asks asks) : world_(world), asks_(asks) {}

  void ask_again() {
    for (std::size_t i = 0; i < kCallers; ++i) {
      if (waiting_[i]) continue;
      waiting_[i] = true;
      asked_[i] = world_.now();
      ask(i);
    }
  }
  int answered() const { return answered_; }
  int unanswered() const { return unanswered_; }
  Duration longest_wait() const { return longest_wait_; }

 private:
  void ask(std::size_t caller) {
    const auto context = world_.context("poller-" + std::to_string(caller), minutes(1));
    if (asks_ == Asks::status) {
      world_.controller().refresh(Duration::zero(), context, world_.now(),
                                  [this, caller](const Result<State>& state) { hear(caller, state.has_value()); });
      return;
    }
    world_.controller().execute({{std::string(kOwnQuestions[caller])}, context}, world_.now(),
                                [this, caller](const ExecuteEvent& event) {
                                  if (event.kind == ExecuteEvent::Kind::ended) hear(caller, !event.problem);
                                });
  }
  void hear(std::size_t caller, bool answered) {
    waiting_[caller] = false;
    ++(answered ? answered_ : unanswered_);
    longest_wait_ = std::max(longest_wait_, world_.now() - asked_[caller]);
  }

  World& world_;
  Asks asks_;
  std::array<bool, kCallers> waiting_{};
  std::array<TimePoint, kCallers> asked_{};
  int answered_ = 0, unanswered_ = 0;
  Duration longest_wait_{};
};

PathRequest request_of(const World& world, const Track& track, int segments) {
  PathRequest path;
  path.context = world.context("owner", minutes(1));
  for (int i = 0; i < segments; ++i) {
    const auto [first, second] = track.way(i);
    path.segments.push_back({{{1, pulses(first), {}}, {2, pulses(second), {}}}, true, pulses(Track::kSpeed), {}});
  }
  return path;
}

struct Course {
  Refills refills = Refills::reserved;
  Pollers::Asks asks = Pollers::Asks::own_question;
  int segments = 10'000;
  milliseconds each = milliseconds(60);
  Duration answer_delay{};  // delay of the controller's answers
  Faults faults = Faults::none();
};

struct Ended {
  Motion motion;
  std::array<std::int64_t, 2> position{};
  int answered = 0, unanswered = 0;
  Duration longest_wait{};
};

Ended end_of(const Course& run) {
  auto setup = quiet();
  setup.profile.refills = run.refills;
  World world(setup);
  EXPECT_TRUE(world.run_until_up()) << world.replay();
  world.device().set_answer_delay(run.answer_delay, world.now());
  world.set_faults(run.faults);
  Pollers pollers(world, run.asks);
  const auto ask_until = [&](const std::function<bool()>& done, Duration limit) {
    const auto ask_and_look = [&] {
      pollers.ask_again();
      return done();
    };
    EXPECT_TRUE(world.run_until(ask_and_look, limit)) << world.replay();
  };
  ask_until([&] { return pollers.answered() > 10 * kCallers; }, minutes(1));
  world.controller().run_path(request_of(world, {run.each}, run.segments), world.now(), [](Result<Motion>) {});
  ask_until([&] { return !world.outcomes().empty(); }, run.segments * (run.each + milliseconds(500)));
  EXPECT_TRUE(world.violations().empty()) << world.violations().front() << world.replay();
  if (world.outcomes().empty()) return {};
  return {world.outcomes().front(),
          {world.device().position(1), world.device().position(2)},
          pollers.answered(),
          pollers.unanswered(),
          pollers.longest_wait()};
}

// Expects that no segment was left out or executed twice, wherever the path ended.
void expect_exact(const Ended& ended, const Course& run) {
  EXPECT_EQ(ended.motion.state, MotionState::succeeded);
  EXPECT_EQ(ended.motion.segments_done, run.segments);
  EXPECT_EQ(ended.position, Track{run.each}.end(run.segments));
}

void record(const Ended& ended) {
  testing::Test::RecordProperty("underruns", ended.motion.underruns);
  testing::Test::RecordProperty("answered", ended.answered);
  testing::Test::RecordProperty("longest_wait_ms", static_cast<int>(ended.longest_wait / milliseconds(1)));
}

TEST(PacedPath, TenThousandSegmentsWhileSixteenAskForTheStatus) {
  const Course run{.asks = Pollers::Asks::status};
  const Ended ended = end_of(run);
  record(ended);
  expect_exact(ended, run);
  EXPECT_EQ(ended.motion.underruns, 0);
  EXPECT_EQ(ended.unanswered, 0);
  EXPECT_GT(ended.answered, run.segments * kCallers);
  EXPECT_LT(ended.longest_wait, 2 * run.each);
}

TEST(PacedPath, TenThousandSegmentsWhileSixteenAskAQuestionEach) {
  const Course run;
  const Ended ended = end_of(run);
  record(ended);
  expect_exact(ended, run);
  EXPECT_EQ(ended.motion.underruns, 0);
  EXPECT_EQ(ended.unanswered, 0);
  EXPECT_GT(ended.answered, run.segments);
  EXPECT_LT(ended.longest_wait, kCallers * run.each) << "somebody was left behind";
}

// For contrast: a refill that waits its turn among the questions is too late.
TEST(PacedPath, UnderrunsWhereRefillsDoNotGoFirst) {
  const Course run{.refills = Refills::among_questions, .segments = 1000};
  const Ended ended = end_of(run);
  record(ended);
  expect_exact(ended, run);
  EXPECT_GT(ended.motion.underruns, run.segments / 4);
}

// A controller that takes 5 ms to answer: 25 ms are enough for a refill, but not for a refill after a question.
const Course kTight{.segments = 1000, .each = milliseconds(25), .answer_delay = milliseconds(5)};

TEST(PacedPath, NoUnderrunWhereNothingButRefillsFits) {
  const Ended ended = end_of(kTight);
  record(ended);
  expect_exact(ended, kTight);
  EXPECT_EQ(ended.motion.underruns, 0);
}

TEST(PacedPath, UnderrunsWhereTheLineIsNotKeptFree) {
  Course run = kTight;
  run.refills = Refills::first;
  const Ended ended = end_of(run);
  record(ended);
  expect_exact(ended, run);
  EXPECT_GT(ended.motion.underruns, run.segments / 100);
}

// Segments whose ends are not reported are late. They delay no question for longer than kRefillReservedAfterDue.
TEST(PacedPath, QuestionsAreAnsweredThoughNoEndIsHeardOf) {
  Course run{.asks = Pollers::Asks::status, .segments = 100};
  run.faults.drop_notice = 1;
  const Ended ended = end_of(run);
  record(ended);
  expect_exact(ended, run);
  EXPECT_GT(ended.answered, run.segments * kCallers);
  EXPECT_LT(ended.longest_wait, milliseconds(300));
}

TEST(PacedPath, AStopIsNotHeldUp) {
  for (int offset = 0; offset < 60; offset += 3) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    Pollers pollers(world, Pollers::Asks::own_question);
    world.controller().run_path(request_of(world, {milliseconds(60)}, 100), world.now(), [](Result<Motion>) {});
    const TimePoint stop_at = world.now() + milliseconds(1500 + offset);
    const auto ask_until_then = [&] {
      pollers.ask_again();
      return world.now() >= stop_at;
    };
    world.run_until(ask_until_then, stop_at - world.now());
    world.controller().stop({}, world.context("stopper"), world.now(), [](const StopReport&) {});
    const std::size_t before = world.wire().commands().size();
    const bool written_at_once =
        world.run_until([&] { return written(world, "L:", before - 1) > 0; }, milliseconds(20));
    EXPECT_TRUE(written_at_once) << offset << world.replay();
    EXPECT_LE(world.wire().commands().size(), before + 1) << "something went before it";
  }
}

TEST(PacedPath, WhatTheLineCannotFeedIsRefusedBeforeAnythingIsSent) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const std::size_t before = world.wire().commands().size();
  std::optional<Result<Motion>> told;
  const auto hear = [&](Result<Motion> motion) { told = std::move(motion); };
  world.controller().run_path(request_of(world, {milliseconds(15)}, 50), world.now(), hear);
  ASSERT_TRUE(told && !told->has_value());
  EXPECT_EQ(told->error().reason, Reason::too_fast);
  EXPECT_EQ(told->error().message,
            "segment 1 takes 15.0 ms, in which a line of 38400 baud cannot set the next one: the shortest feasible "
            "segment time is 16.8 ms");
  EXPECT_EQ(told->error().hint,
            "let every segment but the last take 16.8 ms or more: longer or slower ones, or a higher baud rate");
  EXPECT_EQ(motion_lines(world, before), 0);
  EXPECT_TRUE(world.outcomes().empty()) << "it became a motion";
}

}  // namespace
}  // namespace axisgate::simulation
