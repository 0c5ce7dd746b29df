// Tests of the line in doubt, one rule each. Each fails without the guard that it tests (tests/guards/table.cc).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

// Replaces the first line of a kind that begins with `prefix`. A reply is chosen by the command that it answers.
Script replace_first(World& world, LineKind kind, std::string prefix, std::string instead, Duration delay = {}) {
  return [&world, kind, prefix, instead, delay, done = false](LineKind seen, const std::string& line) mutable {
    const std::string& command = kind == LineKind::reply ? world.wire().commands().back() : line;
    if (done || seen != kind || !command.starts_with(prefix)) return Scripted{};
    done = true;
    return Scripted{.drop = false, .delay = delay, .instead = instead};
  };
}

void expect_no_mix_up(World& world) {
  ASSERT_TRUE(world.violations().empty()) << world.violations().front() << "\n" << world.replay();
}

// Asks all `lines` at once, each for a different caller. Returns the answers in the order of `lines`.
std::vector<std::string> ask_at_once(World& world, const std::vector<std::string>& lines) {
  auto heard = std::make_shared<std::vector<std::string>>(lines.size());
  auto open = std::make_shared<std::size_t>(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    world.controller().execute({{lines[i]}, world.context("caller " + std::to_string(i))}, world.now(),
                               [heard, open, i](const ExecuteEvent& event) {
                                 if (event.kind == ExecuteEvent::Kind::reply) (*heard)[i] = event.answer;
                                 if (event.kind == ExecuteEvent::Kind::ended) --*open;
                               });
  }
  EXPECT_TRUE(world.run_until([open] { return *open == 0; }, seconds(60))) << world.replay();
  return *heard;
}

// A byte of the setting was doubled, and a reading after the axis number lost one.
TEST(Hazard, H04_AReadingThatContradictsTheOneBeforeIsNotTheEnd) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int ready = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind == LineKind::command && line == "MP:1+P1000") return {.instead = "MP:1+P11000\r\n"};
    const auto place = line.find("11000");
    if (kind != LineKind::reply || place == std::string::npos || !line.ends_with("R,R,R") || ++ready != 2) return {};
    return {.instead = std::string(line).replace(place, 5, "1000") + "\r\n"};
  });
  move_by(world, {{1, 1000}});
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::failed) << world.replay();
  EXPECT_EQ(reason_of(motion), Reason::target_not_reached) << world.replay();
  EXPECT_GE(ready, 4);
}

// The answer to a setting was lost, and another value is read back: the setting is not sent again.
TEST(Hazard, H11_WhatIsReadBackAsAnotherStartsNothing) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  bool lost = false;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::reply) return {};
    const std::string& command = world.wire().commands().back();
    const auto place = line.find("1000");
    if (command == "?:MP" && place != std::string::npos) {
      return {.drop = false, .delay = {}, .instead = std::string(line).replace(place, 4, "9000") + "\r\n"};
    }
    return {.drop = command == "MP:1+P1000" && !std::exchange(lost, true), .delay = {}, .instead = {}};
  });
  move_by(world, {{1, 1000}});
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::failed) << world.replay();
  EXPECT_EQ(reason_of(motion), Reason::line_fault) << world.replay();
  EXPECT_EQ(written(world, "MP:1"), 1) << world.replay();
  EXPECT_EQ(world.device().position(1), 0);
}

// Noise cuts a command in two, and both parts are answered: the second answer belongs to no command.
void cut_a_command(const std::string& halves) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(replace_first(world, LineKind::command, "C:11", halves));
  ask_at_once(world, {"C:11", "?:V", "?:P1"});
  world.run_for(seconds(2));
  expect_no_mix_up(world);
}

TEST(Hazard, H10_ALineFaultIsAnsweredTwice) { cut_a_command(std::string("C:\0001\r\n1\r\n", 9)); }

// The same with a refusal: a short silence is the only sign of it.
TEST(Hazard, H10_ARefusalIsAnsweredTwice) { cut_a_command("C:\r\n11\r\n"); }

// Seeds 402608 and 501949: the second answer is late, from a slow controller or over a slow line.
TEST(Hazard, H10_ASecondRefusalComesLate) {
  for (int late = 10; late < 900 && !HasFailure(); late += 10) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 700}});  // a counter other than 0 shows that the controller has not restarted
    int refusals = 0;
    world.wire().set_script([&](LineKind kind, const std::string& text) -> Scripted {
      if (kind == LineKind::command && text == "C:11" && refusals == 0) {
        return {.drop = false, .delay = {}, .instead = "C:\r\n11\r\n"};
      }
      const bool second = kind == LineKind::reply && text == "NG" && ++refusals == 2;
      return {.drop = false, .delay = second ? milliseconds(late) : Duration::zero(), .instead = {}};
    });
    EXPECT_THAT(ask_at_once(world, {"C:11", "?:V", "C:21"}), ElementsAre("NG", "V2.00.000", "OK")) << late;
    EXPECT_GE(refusals, 2);
    expect_no_mix_up(world);
  }
}

// A stop does not wait for the silence: the second refusal is not believed.
TEST(Hazard, H10_ASecondRefusalIsNotTheAnswerOfAStop) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(replace_first(world, LineKind::command, "C:11", "C:\r\n11\r\n"));
  world.controller().execute({{"C:11"}, world.context("caller")}, world.now(), [](const ExecuteEvent&) {});
  world.run_for(milliseconds(1));
  const StopReport report = stopped(world);
  EXPECT_FALSE(report.problem) << report.problem->message;
  expect_no_mix_up(world);
}

// If a stop was cut in two, the following stops, one for each axis, wait for the silence.
TEST(Hazard, H10_AStopCutInTwoIsAnsweredTwice) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(replace_first(world, LineKind::command, "L:D", "LD\r\n:\r\n"));
  const StopReport report = stopped(world);
  EXPECT_FALSE(report.problem) << report.problem->message;
  for (const StopReport::Axis& axis : report.axes) EXPECT_EQ(axis.wire_reply, "OK") << axis.axis;
  expect_no_mix_up(world);
}

// Garbage was not the answer: the true answer may still come.
TEST(Hazard, H10_GarbageBeforeTheAnswer) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(replace_first(world, LineKind::reply, "C:11", "\x7F\r\nOK\r\n"));
  ask_at_once(world, {"C:11", "C:21", "C:31"});
  world.run_for(seconds(2));
  expect_no_mix_up(world);
}

// The last probe but one is answered late, and the last is refused after the barrier. No other command was refused.
TEST(Hazard, H02_AProbeGivenUpIsRefused) {
  for (int late = 40; late < 200 && !HasFailure(); late += 3) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    int probes = 0;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (kind == LineKind::command && line.starts_with("C:11")) return {.drop = true, .delay = {}, .instead = {}};
      const bool probe = kind == LineKind::reply && world.wire().commands().back() == "*IDN?";
      if (!probe || ++probes > 2) return {};
      if (probes == 1) return {.drop = false, .delay = milliseconds(540), .instead = {}};
      return {.drop = false, .delay = milliseconds(late), .instead = "NG\r\n"};
    });
    execute(world, {"C:11"});
    for (int i = 0; i < 20; ++i) ask_at_once(world, {"?:V", "?:P1", "?:D1"});
    expect_no_mix_up(world);
  }
}

// The answer to an abandoned probe is received after the barrier, while another line waits for its answer.
TEST(Hazard, H02_AnIdentityAfterTheBarrier) {
  for (int late = 40; late < 200 && !HasFailure(); late += 3) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    int probes = 0;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (kind == LineKind::command && line.starts_with("C:11")) return {.drop = true, .delay = {}, .instead = {}};
      const bool probe = kind == LineKind::reply && world.wire().commands().back() == "*IDN?";
      if (!probe || ++probes > 2) return {};
      return {.drop = false, .delay = milliseconds(probes == 1 ? 540 : late), .instead = {}};
    });
    execute(world, {"C:11"});
    const std::uint64_t barriers = world.barriers();
    for (int i = 0; i < 20; ++i) ask_at_once(world, {"?:V", "?:P1", "?:D1"});
    expect_no_mix_up(world);
    EXPECT_EQ(world.barriers(), barriers) << "an owed answer begins no barrier\n" << world.replay();
  }
}

// The OK of a stop that is written inside a barrier is received after the identity requested before it. Meanwhile a
// motion's setting waits for the end of the barrier.
TEST(Hazard, H02_AStopInsideABarrier) {
  int inside = 0;
  for (int at = 500; at < 580 && !HasFailure(); at += 2) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 700}});
    world.wire().set_script([&, stops = 0](LineKind kind, const std::string& line) mutable -> Scripted {
      if (kind == LineKind::command && line == "?:V") return {.drop = true, .delay = {}, .instead = {}};
      if (kind != LineKind::reply) return {};
      const bool probe = line.starts_with("SIGMAKOKI");
      const bool stop = line == "OK" && written(world, "L:") > 0 && ++stops == 1;
      return {.drop = false, .delay = milliseconds(probe ? 30 : stop ? 150 : 0), .instead = {}};
    });
    world.controller().execute({{"?:V"}, world.context("asker")}, world.now(), [](const ExecuteEvent&) {});
    move_by(world, {{1, 100}});
    world.run_for(milliseconds(at));
    inside += world.barriers() > 0 ? 1 : 0;
    world.controller().stop(AxisSet::of(3), world.context("stopper"), world.now(), [](const StopReport&) {});
    EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  }
  EXPECT_GT(inside, 0);
}

// A line just after the identity belongs to no command.
TEST(Hazard, H02_TheBarrierEndsWithSilence) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(drop_first(world, LineKind::command, "C:11"));
  world.controller().execute({{"C:11"}, world.context("tester")}, world.now(), [](const ExecuteEvent&) {});
  ASSERT_TRUE(world.run_until([&] { return written(world, "*IDN?") == 2; }, seconds(5))) << world.replay();
  const std::size_t first = world.wire().commands().size();
  const TimePoint asked = world.now();
  ASSERT_TRUE(world.run_until([&] { return world.wire().commands().size() > first; }, seconds(5))) << world.replay();
  EXPECT_GE(world.now() - asked, milliseconds(50)) << world.replay();
}

// Seeds 201536 and 303141: the line was lost while an identity was requested, and a slow controller still sends it. The
// gateway takes it for the new one. Answers to stops that were written before must not match any command.
void stop_over_a_reopened_line(const std::vector<std::string>& answers) {
  World world(quiet());
  world.device().set_answer_delay(milliseconds(400), world.now());
  std::size_t stops = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind == LineKind::command && line.starts_with("L:")) return {.drop = false, .delay = {}, .instead = "L:9\r\n"};
    if (kind != LineKind::reply || line != "NG" || stops >= answers.size()) return {};
    return {.drop = false, .delay = {}, .instead = answers[stops++]};
  });
  ASSERT_TRUE(world.run_until([&] { return written(world, "*IDN?") == 1; }, seconds(1)));
  world.run_for(milliseconds(250));
  world.wire().cut(world.now(), {});
  for (int axis = 1; axis <= static_cast<int>(answers.size()); ++axis) {
    world.controller().stop(AxisSet::of(axis), world.context("caller"), world.now(), [](const StopReport&) {});
  }
  world.run_for(seconds(5));
  EXPECT_EQ(stops, answers.size());
  expect_no_mix_up(world);
}

TEST(Hazard, H02_TheSilenceAfterAReconnect) { stop_over_a_reopened_line({"NG\r\n"}); }

// The first answer loses its line end.
TEST(Hazard, H02_HalfALineInTheSilence) { stop_over_a_reopened_line({"NG", "NG\r\n"}); }

// Returns faults that double every answer, with a pause in the middle of the second one.
Faults doubled_and_split() {
  Faults faults;
  faults.double_reply = faults.split = 1;
  return faults;
}

TEST(Hazard, H09_HalfALineIsNotJoinedToTheNextAnswer) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.set_faults(doubled_and_split());
  for (int i = 0; i < 100 && !HasFatalFailure(); ++i) {
    EXPECT_THAT(ask_at_once(world, {"C:11", "C:21", "C:31"}), Each("OK"));
    expect_no_mix_up(world);
  }
}

TEST(Hazard, H09_HalfALineIsNotJoinedToTheAnswerOfAStop) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.set_faults(doubled_and_split());
  for (int i = 0; i < 50 && !HasFatalFailure(); ++i) {
    execute(world, {"C:11"});
    stopped(world);
    expect_no_mix_up(world);
  }
}

// The line is longer than any answer, so part of it was cut off.
TEST(Hazard, H09_ALineWithoutEndIsNoAnswer) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(replace_first(world, LineKind::reply, "?:V", "V2.00." + std::string(300, '0') + "\r\n"));
  EXPECT_THAT(execute(world, {"?:V"}), ElementsAre("LINE_FAULT")) << world.replay();
}

TEST(Line, EachQuestionHasItsOwnAnswer) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(ask_at_once(world, {"?:N", "?:V", "?:BEEP", "?:D1"}),
              ElementsAre("SHRC-203", "V2.00.000", "1", "S1000F50000R100"))
      << world.replay();
}

// On a dead line the time between two attempts grows to 5 s.
TEST(Line, IsReopenedEverMoreSlowly) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script([](LineKind kind, const std::string&) {
    return Scripted{.drop = kind != LineKind::command, .delay = {}, .instead = {}};
  });
  world.run_for(seconds(30));
  const std::size_t first = world.wire().commands().size();
  world.run_for(seconds(60));
  EXPECT_LE(world.wire().commands().size() - first, 33u) << world.replay();  // three probes of 0.5 s and 5 s
  EXPECT_GE(world.wire().commands().size() - first, 20u) << world.replay();
}

// Another unit has replaced the first without any restart: the *IDN? of the barrier shows it.
TEST(Hazard, H32_AnotherUnitAnswersInABarrier) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.device().set_serial_number("2106001002");
  world.wire().set_script(drop_first(world, LineKind::reply, "?:V"));
  execute(world, {"?:V"});
  EXPECT_NE(world.controller().state().link, LinkState::up) << world.replay();
  EXPECT_THAT(world.controller().state().link_problem, HasSubstr("2106001002"));
}

// A text that cannot be the last line is not the answer to ?:CMD; the real answer is still to come.
TEST(Hazard, H10_GarbageBeforeTheLineBefore) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  ASSERT_TRUE(world.run_until([&] { return world.wire().commands().back() == "?:CMD"; }, seconds(5)));
  world.controller().receive("xx\r\n", world.now());
  world.run_for(seconds(5));
  EXPECT_EQ(world.barriers(), 1u) << world.replay();
  expect_no_mix_up(world);
}

TEST(Handshake, OneMisreadDigitTakesNoAxisAway) {
  World world(quiet());
  world.wire().set_script(replace_first(world, LineKind::reply, "?:AXIS", "2\r\n"));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_EQ(world.controller().state().controllable(), kAllAxes) << world.replay();
}

// A question that a completion could answer waits no longer than its caller does.
TEST(Line, AQuestionThatWaitsIsToldWhenItsTimeIsOver) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(milliseconds(500));
  std::optional<Reason> reason;
  world.controller().execute({{"?:W"}, world.context("tester", seconds(1))}, world.now(),
                             [&](const ExecuteEvent& event) {
                               if (event.problem) reason = event.problem->reason;
                             });
  ASSERT_TRUE(world.run_until([&] { return reason.has_value(); }, milliseconds(1010))) << world.replay();
  EXPECT_EQ(*reason, Reason::completion_outstanding);
  EXPECT_TRUE(world.device().busy(1));
}

}  // namespace
}  // namespace axisgate::simulation
