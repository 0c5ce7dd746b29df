// Tests of a stage controller that shares nothing with the SHRC-203, with its own simulation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/double/kind.h"
#include "tests/double/rig.h"

namespace axisgate::rotor {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Rotor, ComesUp) {
  Rig rig;
  const State& state = rig.controller.state();
  EXPECT_EQ(state.link, LinkState::up);
  EXPECT_EQ(state.model, "ROTOR");
  EXPECT_EQ(state.serial_number, "4711");
  EXPECT_EQ(state.firmware, "2");
  EXPECT_EQ(state.controllable(), kAxis);
  EXPECT_EQ(state.axis(1).position_pulses, 0);
  EXPECT_EQ(rig.told<LinkChanged>(), 2) << "connecting, up";
  EXPECT_EQ(rig.porter.restarts, 0);
}

TEST(Rotor, AnotherOneIsTalkedToNoFurther) {
  Profile profile;
  profile.serial_number = "99";
  Rig rig(false, profile);
  EXPECT_EQ(rig.controller.state().link, LinkState::down);
  EXPECT_THAT(rig.controller.state().link_problem, HasSubstr("rotor 4711 answers, but 99"));
  EXPECT_EQ(rig.written(Opcode::status), 0);
}

TEST(Rotor, Moves) {
  Rig rig;
  const MotionId id = rig.move(2000);
  EXPECT_EQ(rig.motion(id).state, MotionState::queued);
  rig.run(milliseconds(20));
  EXPECT_EQ(rig.motion(id).state, MotionState::running);
  ASSERT_EQ(rig.answers.size(), 1u);
  EXPECT_TRUE(rig.answers[0]);
  EXPECT_EQ(rig.outcome(id), MotionState::succeeded);
  EXPECT_EQ(rig.motion(id).results[0].command_pulses, 2000);
  EXPECT_EQ(rig.rotor.position(), 2000);
  EXPECT_EQ(rig.written(Opcode::move), 1);
  EXPECT_THAT(rig.porter.begun, ElementsAre(id));
  EXPECT_THAT(rig.porter.ended, ElementsAre(id));
  EXPECT_EQ(rig.told<MotionChanged>(), 3) << "queued, running, succeeded";
}

TEST(Rotor, ReversedCountsTheOtherWay) {
  Rig rig(true);
  EXPECT_EQ(rig.outcome(rig.move(300)), MotionState::succeeded);
  EXPECT_EQ(rig.rotor.position(), -300);
  EXPECT_EQ(rig.controller.state().axis(1).position_pulses, 300);
}

TEST(Rotor, MotionsTakeTurns) {
  Rig rig;
  const MotionId first = rig.move(500), second = rig.move(-500);
  EXPECT_EQ(rig.controller.queued(Lane::motion), 1u);
  EXPECT_EQ(rig.outcome(second), MotionState::succeeded);
  EXPECT_EQ(rig.motion(first).state, MotionState::succeeded);
  EXPECT_LE(rig.motion(first).ended, rig.motion(second).started);
}

TEST(Rotor, Homes) {
  Rig rig;
  const MotionId id = rig.home();
  EXPECT_EQ(rig.outcome(id), MotionState::succeeded);
  EXPECT_TRUE(rig.controller.state().axis(1).homed);
  EXPECT_EQ(rig.controller.state().axis(1).homings, 1);
  EXPECT_EQ(rig.rotor.position(), 0);
  EXPECT_GE(rig.motion(id).ended - rig.motion(id).started, milliseconds(490)) << "5,000 pulses at 10,000 a second";
}

TEST(Rotor, StopsDuringAMove) {
  Rig rig;
  const MotionId running = rig.move(50'000), waiting = rig.move(0);
  rig.run(milliseconds(500));
  std::vector<StopReport> reports;
  rig.controller.stop({}, {.who = "bert"}, rig.now, [&](const StopReport& report) { reports.push_back(report); });
  EXPECT_EQ(rig.motion(waiting).state, MotionState::stopped);
  EXPECT_EQ(rig.motion(running).state, MotionState::stopping);
  rig.run(milliseconds(50));
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_FALSE(reports[0].problem);
  EXPECT_EQ(reports[0].axes[0].ready, true);
  EXPECT_EQ(rig.motion(running).state, MotionState::stopped);
  EXPECT_THAT(rig.motion(running).problem->message, HasSubstr("bert"));
  EXPECT_LT(rig.rotor.position(), 6000);
  EXPECT_THAT(rig.porter.stops, ElementsAre("bert"));
  EXPECT_THAT(rig.porter.ended, ElementsAre(running)) << "the other never had its turn";
  EXPECT_EQ(rig.written(Opcode::move), 1);
}

TEST(Rotor, AStoppedOriginReturnHasFoundNothing) {
  Rig rig;
  const MotionId id = rig.home();
  rig.run(milliseconds(10));
  rig.controller.stop({}, {.who = "anna"}, rig.now, [](const StopReport&) {});
  EXPECT_EQ(rig.outcome(id), MotionState::stopped);
  EXPECT_FALSE(rig.controller.state().axis(1).homed);
}

TEST(Rotor, RefusesWhatItCannot) {
  Rig rig;
  rig.controller.run_path({}, rig.now, rig.answer());
  EXPECT_EQ(rig.refusal(), Reason::not_allowed);
  EXPECT_EQ(rig.answers.back().error().message, "device stage: a rotor has no look-ahead: paths are not possible");
  EXPECT_NE(rig.answers.back().error().hint, "");
  rig.controller.scan({}, rig.now, rig.answer());
  EXPECT_EQ(rig.refusal(), Reason::not_allowed);
  rig.controller.go_to_position({}, rig.now, rig.answer());
  EXPECT_EQ(rig.refusal(), Reason::not_allowed);
  std::vector<ExecuteEvent> lines;
  rig.controller.execute({{"Q:"}, {}}, rig.now, [&](const ExecuteEvent& event) { lines.push_back(event); });
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].kind, ExecuteEvent::Kind::ended);
  EXPECT_EQ(lines[0].problem->reason, Reason::not_allowed);
  const SpeedProfile fast{pulses(1), pulses(100), 10};
  rig.controller.move({{AxisMove{.axis = 1, .distance = pulses(5), .profile = fast}}, false, {}}, rig.now,
                      rig.answer());
  EXPECT_EQ(rig.refusal(), Reason::not_allowed);
  rig.controller.move({{AxisMove{.axis = 2, .distance = pulses(5), .profile = {}}}, false, {}}, rig.now, rig.answer());
  EXPECT_EQ(rig.refusal(), Reason::unknown_axis);
  EXPECT_THAT(rig.controller.motions(), IsEmpty());
}

TEST(Rotor, ALostAnswerIsNotAskedForWithASecondMove) {
  Rig rig;
  rig.lose_answer = Opcode::move;
  const MotionId ran = rig.move(5000);
  EXPECT_EQ(rig.outcome(ran), MotionState::succeeded) << "the status showed it moving";
  EXPECT_EQ(rig.written(Opcode::move), 1);
  rig.lose_answer.reset();
  rig.lose_command = Opcode::move;
  const MotionId lost = rig.move(0);
  EXPECT_EQ(rig.outcome(lost), MotionState::unknown);
  EXPECT_EQ(rig.motion(lost).problem->reason, Reason::outcome_unknown);
  EXPECT_EQ(rig.rotor.position(), 5000);
  EXPECT_EQ(rig.written(Opcode::move), 2) << "one each";
  EXPECT_EQ(rig.controller.state().link, LinkState::up);
  ASSERT_EQ(rig.answers.size(), 2u);
  EXPECT_TRUE(rig.answers[1]) << "unknown is an outcome, not a refusal";
}

TEST(Rotor, AnOriginFoundBeforeIsNoOutcomeOfALostStart) {
  Rig rig;
  EXPECT_EQ(rig.outcome(rig.home()), MotionState::succeeded);
  rig.lose_command = Opcode::home;
  EXPECT_EQ(rig.outcome(rig.home()), MotionState::unknown);
}

TEST(Rotor, ASilentRotorIsLostAfterThreeRepeatsAndComesBack) {
  Rig rig;
  const MotionId id = rig.move(1'000'000);
  rig.run(milliseconds(100));
  ASSERT_TRUE(rig.rotor.operate("fault silent", rig.now));
  const int asked = rig.written(Opcode::status);
  rig.run(milliseconds(1350));
  EXPECT_EQ(rig.written(Opcode::status), asked + 4);
  EXPECT_EQ(rig.controller.state().link, LinkState::down);
  EXPECT_EQ(rig.motion(id).state, MotionState::unknown);
  EXPECT_TRUE(rig.controller.state().moving_unknown);
  rig.move(5);
  EXPECT_EQ(rig.refusal(), Reason::link_down);
  rig.run(seconds(6));
  EXPECT_THAT(rig.reopened, ElementsAre(milliseconds(250), milliseconds(500), milliseconds(1000), milliseconds(2000)));
  ASSERT_TRUE(rig.rotor.operate("fault answering", rig.now));
  rig.run(seconds(4));
  EXPECT_EQ(rig.controller.state().link, LinkState::up);
  EXPECT_EQ(rig.controller.state().device_epoch, 2u);
  EXPECT_EQ(rig.porter.restarts, 1);
  EXPECT_EQ(rig.written(Opcode::move), 1);
  EXPECT_TRUE(rig.controller.state().axis(1).foreign_motion) << "it runs on, and is nobody's";
}

TEST(Rotor, ALeaseIsAskedForBeforeAndAsTheBytesGo) {
  Rig rig;
  rig.porter.refusing = true;
  rig.move(10);
  EXPECT_EQ(rig.refusal(), Reason::lease_held);
  EXPECT_THAT(rig.controller.motions(), IsEmpty());
  for (const int yes : {1, 2}) {  // refused at its turn, and just before its bytes are written
    rig.porter.refusing = false;
    rig.porter.answers_left = yes;
    const MotionId id = rig.move(10);
    EXPECT_EQ(rig.outcome(id), MotionState::failed);
    EXPECT_EQ(rig.motion(id).problem->reason, Reason::lease_held);
  }
  EXPECT_EQ(rig.written(Opcode::move), 0);
  EXPECT_EQ(rig.porter.begun.size(), 1u);
  EXPECT_EQ(rig.porter.begun, rig.porter.ended);
}

TEST(Rotor, AStopWhileTheStartIsOnItsWayStopsWhatItStarted) {
  Rig rig;
  const MotionId id = rig.move(50'000);
  for (int i = 0; i < 100 && rig.written(Opcode::move) == 0; ++i) rig.run(milliseconds(1));
  EXPECT_EQ(rig.motion(id).state, MotionState::queued);
  rig.controller.emergency_stop({.who = "bert"}, rig.now, [](const StopReport&) {});
  EXPECT_EQ(rig.outcome(id), MotionState::stopped);
  EXPECT_FALSE(rig.rotor.busy());
  EXPECT_EQ(rig.written(Opcode::stop), 1);
}

TEST(Rotor, AStopOfAStartThatWasNotAnsweredGoesNoLaterThanItsTimeLimit) {
  Rig rig;
  rig.lose_answer = Opcode::move;
  const MotionId id = rig.move(50'000);
  rig.run(milliseconds(50));
  rig.controller.stop({}, {.who = "bert"}, rig.now, [](const StopReport&) {});
  rig.run(kReplyLimit);
  EXPECT_FALSE(rig.rotor.busy());
  EXPECT_EQ(rig.outcome(id), MotionState::unknown) << "it was not seen to move";
}

TEST(Rotor, NobodysTurnComesWhileItIsBeingStopped) {
  Rig rig;
  bool stands = false;
  rig.controller.stop({}, {.who = "bert"}, rig.now, [&](const StopReport&) { stands = true; });
  const MotionId id = rig.move(100);
  EXPECT_THAT(rig.porter.begun, IsEmpty());
  for (int i = 0; i < 100 && !stands; ++i) {
    EXPECT_THAT(rig.porter.begun, IsEmpty());
    rig.run(milliseconds(1));
  }
  EXPECT_TRUE(stands);
  EXPECT_EQ(rig.outcome(id), MotionState::succeeded);
}

TEST(Rotor, CancelsWhatWaitsAndStopsWhatRuns) {
  Rig rig;
  const MotionId running = rig.move(50'000), waiting = rig.move(0);
  rig.run(milliseconds(100));
  std::vector<Result<void>> done;
  const auto note = [&](const Result<void>& one) { done.push_back(one); };
  rig.controller.cancel_motion(waiting, {.who = "anna"}, rig.now, note);
  EXPECT_EQ(rig.motion(waiting).state, MotionState::stopped);
  EXPECT_TRUE(rig.rotor.busy());
  rig.controller.cancel_motion(running, {.who = "anna"}, rig.now, note);
  rig.controller.cancel_motion(99, {.who = "anna"}, rig.now, note);
  rig.run(milliseconds(100));
  EXPECT_EQ(rig.motion(running).state, MotionState::stopped);
  ASSERT_EQ(done.size(), 3u);
  EXPECT_EQ(done[1].error().reason, Reason::not_found);
  EXPECT_TRUE(done[2]);
}

TEST(Rotor, AsksAnewOnlyWhereTheStateIsTooOld) {
  Rig rig;
  const int asked = rig.written(Opcode::status);
  int answered = 0;
  const auto note = [&](const Result<State>& state) { answered += state ? 1 : 0; };
  rig.controller.refresh(seconds(10), {.who = "anna"}, rig.now, note);
  EXPECT_EQ(answered, 1);
  rig.controller.refresh(Duration::zero(), {.who = "anna"}, rig.now, note);
  rig.run(milliseconds(10));
  EXPECT_EQ(answered, 2);
  EXPECT_EQ(rig.written(Opcode::status), asked + 1);
}

TEST(Rotor, ACallbackMayAskForMore) {
  Rig rig;
  rig.controller.move({{AxisMove{.axis = 1, .distance = pulses(100), .profile = {}}}, false, {.who = "anna"}}, rig.now,
                      [&](const Result<Motion>&) { rig.move(-100); });
  EXPECT_EQ(rig.outcome(2), MotionState::succeeded);
  EXPECT_EQ(rig.rotor.position(), -100);
}

TEST(Rotor, ARequestOfAPassedEpochIsRefused) {
  Rig rig;
  rig.controller.home({{}, {.who = "anna", .device_epoch = 7}}, rig.now, rig.answer());
  EXPECT_EQ(rig.refusal(), Reason::epoch_passed);
}

TEST(Rotor, CarriesOutOrders) {
  Rig rig;
  const MotionId id = rig.move(50'000);
  rig.run(milliseconds(100));
  rig.porter.orders = {{{7, kAxis, "carl"}}, {{3, "anna"}}};
  rig.run(milliseconds(100));
  EXPECT_EQ(rig.motion(id).state, MotionState::stopped);
  EXPECT_THAT(rig.porter.carried_out, ElementsAre(7));
  EXPECT_THAT(rig.porter.restored, ElementsAre(3));
  EXPECT_THAT(rig.porter.stops, IsEmpty()) << "nobody asked for it here";
}

TEST(Rotor, WindsDown) {
  for (const AtExit at_exit : {AtExit::stop, AtExit::finish}) {
    Profile profile;
    profile.at_exit = at_exit;
    Rig rig(false, profile);
    const MotionId running = rig.move(20'000), waiting = rig.move(0);
    rig.run(milliseconds(100));
    std::vector<WindDownReport> reports;
    rig.controller.wind_down(rig.now, [&](const WindDownReport& report) { reports.push_back(report); });
    EXPECT_EQ(rig.motion(waiting).problem->reason, Reason::not_sent);
    rig.move(1);
    EXPECT_EQ(rig.refusal(), Reason::not_sent);
    rig.run(seconds(3));
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_FALSE(reports[0].problem);
    EXPECT_EQ(reports[0].motions.size(), 2u);
    const bool finishes = at_exit == AtExit::finish;
    EXPECT_EQ(rig.motion(running).state, finishes ? MotionState::succeeded : MotionState::stopped);
    EXPECT_EQ(rig.written(Opcode::stop), finishes ? 0 : 1);
    const std::size_t said = rig.commands.size();
    rig.run(seconds(5));
    EXPECT_EQ(rig.commands.size(), said) << "and then it is silent";
  }
}

TEST(Rotor, WindsDownWithoutAnAnswer) {
  Rig rig;
  const MotionId id = rig.move(20'000);
  rig.run(milliseconds(100));
  ASSERT_TRUE(rig.rotor.operate("fault silent", rig.now));
  std::vector<WindDownReport> reports;
  rig.controller.wind_down(rig.now, [&](const WindDownReport& report) { reports.push_back(report); });
  rig.run(seconds(15));
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].problem->reason, Reason::outcome_unknown);
  EXPECT_EQ(rig.motion(id).state, MotionState::unknown);
}

TEST(Rotor, TheSimulationSaysWhatItKnows) {
  Rig rig;
  EXPECT_EQ(rig.rotor.operate("position", rig.now), "0 pulses, standing");
  EXPECT_EQ(rig.rotor.operate("dance", rig.now).error().reason, Reason::invalid_request);
  EXPECT_TRUE(kind().check_option("speed", "500"));
  EXPECT_THAT(kind().check_option("speed", "0").error().hint, HasSubstr("from 1 to"));
  EXPECT_THAT(kind().check_option("colour", "red").error().hint, HasSubstr("speed, place or serial_number"));
  EXPECT_FALSE(kind().check_lines({"Q:"}));
}

}  // namespace
}  // namespace axisgate::rotor
