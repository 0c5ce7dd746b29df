// Tests of a person's actions at a mill apart from jobs: their commands, typed by hand from the guideline, and when
// they may be sent.
#include "device/rml1/mill/by_hand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "device/rml1/mill/mill_controller.h"
#include "tests/rml1/fake_mill_line.h"
#include "tests/rml1/fake_permission.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

std::string bytes_of(const jobs::HandAct& act, const Profile& profile = test_profile()) {
  const Result<HandCommands> words = words_of(act, profile, jobs::SendSettings().slack);
  return words ? words->bytes : std::string(name(words.error().reason));
}

jobs::JogStep step_of(double x_mm, double y_mm, double z_mm, std::optional<double> mm_per_s = {}) {
  const auto amount = [](double mm) { return Quantity{decimal_of(mm, false).value(), Unit::millimeters}; };
  jobs::JogStep step{amount(x_mm), amount(y_mm), amount(z_mm)};
  if (mm_per_s) step.speed = amount(*mm_per_s);
  return step;
}

// "!MC 0" keeps the spindle off, which a movement would start (5-2). !ZZ is relative after PR (5-3).
TEST(ByHand, AStepIsRelativeAndTheSpindleStopsBeforeIt) {
  EXPECT_EQ(bytes_of(step_of(5, 0, -0.5, 3)), ";!MC0;^PR;!VZ3;!ZZ500,0,-50;^PA;");
  EXPECT_EQ(bytes_of(step_of(0, -50, 50, 3)), ";!MC0;^PR;!VZ3;!ZZ0,-5000,5000;^PA;");
  EXPECT_EQ(text_of(step_of(5, 0, -0.5)), "jog by X 5 mm, Z -0.5 mm");
}

TEST(ByHand, TheSlowestMillIsThatOfTheSettings) {
  const jobs::JogStep step = step_of(50, 0, 0, 10);
  EXPECT_EQ(words_of(step, test_profile(), 2)->longest, 2 * words_of(step, test_profile(), 1)->longest);
  EXPECT_EQ(words_of(jobs::TurnSpindle{true}, test_profile(), 3)->longest, 6s) << "it spins up in 2 s";
}

TEST(ByHand, AStepIsShortSinceNothingChecksIt) {
  EXPECT_EQ(bytes_of(step_of(50.1, 0, 0)), "OUT_OF_RANGE");
  EXPECT_EQ(bytes_of(step_of(0, -50.1, 0)), "OUT_OF_RANGE");
  EXPECT_EQ(bytes_of(step_of(0, 0, -5.1)), "OUT_OF_RANGE");
  EXPECT_EQ(bytes_of(step_of(0, 0, 0)), "OUT_OF_RANGE");
}

// A step of the test mill is 0.01 mm.
TEST(ByHand, AStepIsAWholeNumberOfTheMillsSteps) {
  jobs::JogStep step = step_of(0.504, 0, 0);
  EXPECT_EQ(bytes_of(step), "NOT_REPRESENTABLE");
  step.x.nearest = true;
  EXPECT_EQ(bytes_of(step), bytes_of(step_of(0.5, 0, 0)));
  EXPECT_EQ(bytes_of(jobs::JogStep{.x = pulses(50)}), bytes_of(step_of(0.5, 0, 0)));
  EXPECT_EQ(bytes_of(jobs::JogStep{.x = {{90, 0}, Unit::degrees}}), "UNKNOWN_UNIT");
}

TEST(ByHand, AStepIsAsFastAsTheMillCan) {
  const Profile profile = test_profile();
  EXPECT_EQ(bytes_of(step_of(1, 0, 0, profile.speed.z_maximum + 0.01)), "TOO_FAST");
  EXPECT_EQ(bytes_of(step_of(1, 0, 0, profile.speed.z_minimum - 0.01)), "TOO_FAST");
}

// After PR, "the specified value referenced from the present Z-axis coordinate" (3-3 !ZO).
TEST(ByHand, TheOriginIsSetHereOrAtAMachineCoordinate) {
  EXPECT_EQ(bytes_of(jobs::SetZ0{}), ";^PR;!ZO0;^PA;");
  EXPECT_EQ(bytes_of(jobs::SetZ0{pulses(-800)}), ";^PA;!ZO-800;");
  EXPECT_EQ(bytes_of(jobs::SetZ0{pulses(-6050)}), ";^PA;!ZO-6050;") << "60.5 mm below the top";
  EXPECT_EQ(bytes_of(jobs::SetZ0{pulses(-6051)}), "OUT_OF_RANGE");
  EXPECT_EQ(bytes_of(jobs::SetZ0{pulses(1)}), "OUT_OF_RANGE") << "above the top";
  Profile downward = test_profile();
  downward.up = -1;
  EXPECT_EQ(bytes_of(jobs::SetZ0{pulses(6050)}, downward), ";^PA;!ZO6050;");
  EXPECT_EQ(bytes_of(jobs::SetZ0{pulses(-1)}, downward), "OUT_OF_RANGE");
}

// "Rotation is performed at the time of a command that involves movement" (5-2).
TEST(ByHand, TheSpindleAndTheRaise) {
  Profile profile = test_profile();
  profile.speed.z_maximum = 12.5;
  EXPECT_EQ(bytes_of(jobs::TurnSpindle{true}), ";!MC1;^PR;!ZZ0,0,0;^PA;");
  EXPECT_EQ(bytes_of(jobs::TurnSpindle{false}), ";!MC0;");
  EXPECT_EQ(bytes_of(jobs::RaiseTool{}, profile), ";!MC0;^PA;!VZ12.5;!ZM0;");
}

// Compares with the model of the mill, given the same commands.
TEST(ByHand, TheModelGoesWhereTheStepLeads) {
  const Profile profile = test_profile();
  const Played stepped = play("PA;PU1000,1000;" + bytes_of(step_of(5, -1, 0)) + "PU2000,2000;", profile);
  EXPECT_THAT(stepped.diagnostics, IsEmpty());
  EXPECT_THAT(stepped.commanded, Contains(AllOf(Field(&jobs::Point::x, 1500), Field(&jobs::Point::y, 900))));
  EXPECT_EQ(stepped.final.x, 2000) << "what follows is absolute";
  EXPECT_THAT(play(bytes_of(jobs::TurnSpindle{true}), profile).waits, ElementsAre("spin up 2"));
}

class ByHandAtTheMill : public testing::Test, protected jobs::MachineEvents {
 protected:
  void SetUp() override { mill_.link_up(now_); }
  void TearDown() override { EXPECT_EQ(mill_.broken_invariant(), ""); }
  void link_changed(jobs::MachineLink, std::string_view, TimePoint) override {}
  void job_changed(const jobs::Job& job, std::string_view, std::string_view why, TimePoint) override {
    said_ = std::string(name(job.state)) + ": " + std::string(why);
  }
  void rank_changed(const jobs::Job&) override {}
  void z0_sent(std::uint64_t z0_count) override { z0_count_ = z0_count; }
  void internal_error(std::string_view what, TimePoint) override { ADD_FAILURE() << what; }
  void sender_changed(const jobs::RunningJob&, TimePoint) override {}
  void written(std::string_view, jobs::JobNumber) override {}
  void abort_requested(std::string_view, TimePoint) override {}
  void about_to_write(jobs::JobNumber, const jobs::WrittenRange&) override {}

  Reason reason(const jobs::HandAct& act) {
    const Result<Duration> done = mill_.operate(act, {.who = "unix anna"}, now_);
    return done ? Reason::unspecified : done.error().reason;
  }
  void add_confirmed() {
    mill_.add({.number = 1, .name = "part.rml", .owner = "unix anna", .setup = setup_}, now_);
    ASSERT_TRUE(mill_.confirm(1, setup_, "unix bert", now_));
  }
  Result<void> start() {
    auto job = std::make_shared<const PreparedJob>("PU1000,0;", "d1", profile_, std::nullopt, settings_.sending);
    return mill_.start(1, std::move(job), {.who = "unix anna"}, now_);
  }

  const Profile profile_ = test_profile();
  const jobs::JobSetup setup_{"d1", "test", "corner", "T1"};
  FakeMillLine line_;
  TimePoint now_{1000s};
  jobs::MachineSettings settings_;
  std::string said_;
  std::uint64_t z0_count_ = 0;
  FakePermission permission_;
  MillController mill_{profile_, settings_, line_, *this, permission_};
};

TEST_F(ByHandAtTheMill, AConfirmationIsVoidAfterEachOfThem) {
  for (const jobs::HandAct& act : {jobs::HandAct(step_of(1, 0, 0)), jobs::HandAct(jobs::SetZ0{}),
                                   jobs::HandAct(jobs::TurnSpindle{}), jobs::HandAct(jobs::RaiseTool{})}) {
    MillController mill(profile_, settings_, line_, *this, permission_);
    mill.link_up(now_);
    mill.add({.number = 1, .name = "part.rml", .owner = "unix anna", .setup = setup_}, now_);
    ASSERT_TRUE(mill.confirm(1, setup_, "unix bert", now_));
    ASSERT_TRUE(mill.operate(act, {.who = "unix anna"}, now_));
    EXPECT_EQ(said_, "QUEUED: unix anna had the mill " + text_of(act));
    EXPECT_EQ(mill.jobs()[0].state, jobs::JobState::queued);
    line_.run_to(now_ += 10s);
  }
}

TEST_F(ByHandAtTheMill, UntilItIsDoneNothingElseIsSent) {
  add_confirmed();
  const Result<Duration> longest = mill_.operate(step_of(50, 0, 0, 10.0), {.who = "unix anna"}, now_);
  ASSERT_TRUE(longest);
  EXPECT_GE(*longest, 7500ms) << "50 mm at 10 mm/s on a mill that takes half as long again";
  EXPECT_THAT(line_.writes, ElementsAre(";!MC0;^PR;!VZ10;!ZZ5000,0,0;^PA;"));
  line_.run_to(now_ += *longest - 1ms);
  EXPECT_EQ(reason(step_of(0, 1, 0)), Reason::axis_busy) << "steps do not add up";
  ASSERT_TRUE(mill_.confirm(1, setup_, "unix bert", now_));
  EXPECT_EQ(start().error().reason, Reason::axis_busy);
  now_ += 1ms;
  EXPECT_TRUE(start());
}

TEST_F(ByHandAtTheMill, ARaiseIsSentBehindAStep) {
  const auto step = mill_.operate(step_of(10, 0, 0, 10.0), {.who = "unix anna"}, now_);
  line_.run_to(now_ + 100ms);
  const auto raise = mill_.operate(jobs::RaiseTool{}, {.who = "unix anna"}, now_);
  ASSERT_TRUE(step && raise);
  EXPECT_GE(*raise, *step + 4s) << "60.5 mm at 15 mm/s come after it";
  EXPECT_EQ(line_.writes.back(), ";!MC0;^PA;!VZ15;!ZM0;");
}

TEST_F(ByHandAtTheMill, NothingWaitsInTheHostForALaterTime) {
  line_.busy = true;
  EXPECT_EQ(reason(step_of(1, 0, 0)), Reason::axis_busy) << "the mill holds its host back";
  EXPECT_THAT(line_.writes, IsEmpty());
  line_.busy = false;
  ASSERT_EQ(reason(jobs::SetZ0{}), Reason::unspecified);
  EXPECT_EQ(reason(jobs::SetZ0{}), Reason::axis_busy) << "the first one has not left the host";
  line_.run_to(now_ += 1s);
  EXPECT_EQ(reason(jobs::SetZ0{}), Reason::unspecified);
}

TEST_F(ByHandAtTheMill, NotWhileAJobRunsNorByThoseWithoutARightNorThroughAClosedLine) {
  add_confirmed();
  permission_.allowed = false;
  EXPECT_EQ(reason(jobs::RaiseTool{}), Reason::lease_held);
  EXPECT_EQ(mill_.jobs()[0].state, jobs::JobState::confirmed) << "what is refused changes nothing";
  permission_.allowed = true;
  ASSERT_TRUE(start());
  EXPECT_EQ(reason(jobs::RaiseTool{}), Reason::wrong_job_state);
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(reason(jobs::RaiseTool{}), Reason::link_down);
}

TEST_F(ByHandAtTheMill, AnAbortEndsAStep) {
  ASSERT_TRUE(mill_.operate(step_of(50, 0, 0), {.who = "unix anna"}, now_));
  EXPECT_TRUE(mill_.abort({.who = "unix bert"}, now_));
  EXPECT_THAT(line_.writes.back(), HasSubstr("\x1B.K\x1B.K!MC0;"));
}

// A rise of 60.5 mm at 15 mm/s, by a mill that takes half as long again, lasts at least 6.05 s.
TEST_F(ByHandAtTheMill, AfterAnAbortNothingThatNeedsTheToolAtRest) {
  ASSERT_TRUE(mill_.abort({.who = "unix bert"}, now_));
  line_.run_to(now_ += 6s);
  mill_.advance(now_);
  EXPECT_EQ(reason(step_of(1, 0, 0)), Reason::axis_busy) << "the tool may still rise";
  EXPECT_EQ(reason(jobs::SetZ0{}), Reason::axis_busy);
  EXPECT_EQ(reason(jobs::SetZ0{pulses(-800)}), Reason::unspecified) << "it does not matter where the tool is";
  line_.run_to(now_ += 60s);
  EXPECT_EQ(reason(step_of(1, 0, 0)), Reason::unspecified);
}

TEST_F(ByHandAtTheMill, AfterAnAbortThatWaitedForTheLineTheToolRisesLater) {
  mill_.link_down(now_, "unplugged");
  EXPECT_FALSE(mill_.abort({.who = "unix bert"}, now_));
  mill_.link_up(now_ += 60s);
  line_.run_to(now_ += 1s);
  mill_.advance(now_);
  EXPECT_EQ(reason(step_of(1, 0, 0)), Reason::axis_busy) << "the tool may still rise";
  line_.run_to(now_ += 60s);
  EXPECT_EQ(reason(step_of(1, 0, 0)), Reason::unspecified);
}

TEST_F(ByHandAtTheMill, AStepGoesOnUntilAnAbortThatWaitedLeaves) {
  ASSERT_TRUE(mill_.operate(step_of(50, 0, 0, 1.0), {.who = "unix anna"}, now_));
  line_.run_to(now_ += 1s);
  mill_.link_down(now_, "unplugged");
  EXPECT_FALSE(mill_.abort({.who = "unix bert"}, now_));
  mill_.link_up(now_ += 20s);
  line_.run_to(now_ += 1s);
  mill_.advance(now_);
  add_confirmed();
  EXPECT_TRUE(start()) << "the job arrives after the abort, which ends the step";
}

TEST_F(ByHandAtTheMill, CountsHowOftenZ0IsSent) {
  EXPECT_EQ(reason(jobs::SetZ0{pulses(-800)}), Reason::unspecified);
  EXPECT_EQ(reason(jobs::RaiseTool{}), Reason::axis_busy) << "the line has not taken it";
  line_.run_to(now_ += 1s);
  EXPECT_EQ(reason(jobs::RaiseTool{}), Reason::unspecified);
  EXPECT_EQ(mill_.z0_count(), 1u);
  EXPECT_EQ(z0_count_, 1u) << "is kept";
}

}  // namespace
}  // namespace axisgate::rml1
