// Tests of a job that is paused with the tool raised, or was lost, and continues from a place chosen by a person.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "device/rml1/mill/approach.h"
#include "tests/rml1/mill_controller_fixture.h"

namespace axisgate::rml1::mill_continued_test {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using enum jobs::JobState;

// Lift by test_profile(): Z rises with 15 mm/s, and its top is at 0. A permitted spindle turns while the tool rises.
constexpr std::string_view kLift = "^PA;!VZ15;!ZM0;!MC0;";

class MillContinuedTest : public MillControllerTest {
 protected:
  const jobs::Job& job(jobs::JobNumber number) const {
    static const jobs::Job none;
    for (const jobs::Job& one : mill_.jobs()) {
      if (one.number == number) return one;
    }
    ADD_FAILURE() << "there is no job " << number;
    return none;
  }
  void begin(jobs::JobNumber number = 1, int count = 20) {
    jobs::Job job{.number = number, .name = "part.rml", .owner = "unix anna", .setup = setup()};
    job.bytes = vectors(count).size();
    mill_.add(std::move(job), now_);
    run_job(number, count);
  }
  void raise() {
    begin();
    run_for(3s);
    ASSERT_TRUE(mill_.pause(true, now_));
  }
  void raise_to_end() {
    raise();
    run_for(60s);
    ASSERT_EQ(state(1), paused);
  }
  Result<void> confirm_as_shown(jobs::JobNumber number) {
    return mill_.confirm(number, job(number).setup, "unix bert", now_);
  }
  std::shared_ptr<const PreparedJob> rest_from(const jobs::Place& from) const {
    const std::string body = vectors(20);
    const Result<Approach> approach = approach_to(body, from.offset, profile_, std::nullopt);
    return std::make_shared<const PreparedJob>(body, "d1", profile_, std::nullopt, settings_.sending, 0, from,
                                               *approach);
  }
  Result<void> start_rest(const jobs::Place& from) {
    return mill_.start(1, rest_from(from), {.who = "unix anna"}, now_);
  }
};

TEST_F(MillContinuedTest, WhatWasSentIsExecutedThenTheToolRisesAndTheSpindleStops) {
  raise();
  EXPECT_THAT(written(), EndsWith(";" + std::string(kLift)));
  EXPECT_EQ(said_.back(), "RAISING");
  const std::string all = written();
  run_for(1s);
  EXPECT_EQ(state(1), running) << "the slowest mill is not up";
  run_for(60s);
  EXPECT_EQ(written(), all) << "no more of the job";
  EXPECT_EQ(state(1), paused);
  EXPECT_THAT(said_.back(), StartsWith("PAUSED: the tool is up; it continues at line 1, column "));
  EXPECT_THAT(permission_.users, IsEmpty());
}

TEST_F(MillContinuedTest, ItsPlanIsCorrectedWhileItWaitsThere) {
  jobs::Job sent{.number = 1, .name = "part.rml", .owner = "unix anna", .setup = setup()};
  sent.bytes = vectors(20).size();
  sent.parts = {{"T1", sent.bytes}};
  mill_.add(sent, now_);
  run_job(1);
  run_for(3s);
  ASSERT_TRUE(mill_.pause(true, now_));
  run_for(60s);
  ASSERT_EQ(state(1), paused);
  jobs::Job planned = job(1);
  planned.parts[0].takes = {1s, 2s};
  mill_.plan_rest(planned);
  EXPECT_EQ(job(1).parts[0].takes.most, 2s);
  planned.parts[0].takes = {3s, 4s};
  planned.setup.from->offset += 1;
  mill_.plan_rest(planned);
  EXPECT_EQ(job(1).parts[0].takes.most, 2s) << "that was another place";
}

// Place of the second vector: "V15;VS15;" and "PU1000,0;" end at byte 18.
constexpr jobs::Place kSecondVector{18, 1, 19};

TEST_F(MillContinuedTest, TheRestOfAnotherJobWaitsAsAnyOther) {
  jobs::Job rest{.number = 1, .name = "part.rml", .owner = "unix anna", .setup = setup()};
  rest.setup.from = kSecondVector;
  rest.bytes = vectors(20).size();
  mill_.add(rest, now_);
  add(2);
  EXPECT_EQ(state(1), queued);
  ASSERT_TRUE(mill_.move_first(2, jobs::Overtaken::all, "unix root", now_)) << "nothing of it has begun";
  ASSERT_TRUE(mill_.move_first(1, jobs::Overtaken::all, "unix root", now_));
  ASSERT_TRUE(confirm_as_shown(1));
  mill_.setup_changed("a test", now_);
  EXPECT_EQ(state(1), queued);
  EXPECT_EQ(mill_.jobs()[0].setup.from, kSecondVector);
}

TEST_F(MillContinuedTest, TheRestOfAnotherJobContinuesOnceItHasBegun) {
  jobs::Job rest{.number = 1, .name = "part.rml", .owner = "unix anna", .setup = setup()};
  rest.setup.from = kSecondVector;
  rest.bytes = vectors(20).size();
  mill_.add(rest, now_);
  ASSERT_TRUE(confirm_as_shown(1));
  ASSERT_TRUE(start_rest(kSecondVector));
  run_for(5s);
  EXPECT_THAT(written(), HasSubstr("PU0,0;"));
  ASSERT_TRUE(mill_.pause(true, now_));
  run_for(60s);
  ASSERT_EQ(state(1), paused);
  ASSERT_TRUE(confirm_as_shown(1));
  mill_.setup_changed("a test", now_);
  EXPECT_EQ(state(1), paused);
}

TEST_F(MillContinuedTest, ItGoesOnBehindWhatWasSent) {
  raise();
  const std::size_t sent = std::string(";^DF;").size();
  const std::string before = written().substr(sent, written().size() - sent - kLift.size());
  run_for(60s);
  ASSERT_TRUE(job(1).setup.from);
  EXPECT_EQ(*job(1).setup.from, (jobs::Place{before.size(), 1, before.size() + 1}));
}

TEST_F(MillContinuedTest, ItsRestIsConfirmedAndStartedAndLeavesNothingOut) {
  raise_to_end();
  const jobs::Place from = *job(1).setup.from;
  EXPECT_EQ(reason(start_rest(from)), Reason::not_confirmed) << "it is not confirmed";
  EXPECT_EQ(reason(confirm(1)), Reason::setup_changed) << "seen without where it continues";
  ASSERT_TRUE(confirm_as_shown(1));
  line_.writes.clear();
  noted_ = 0;
  ASSERT_TRUE(start_rest(from));
  EXPECT_EQ(noted_, from.offset) << "the approach is none of the job's";
  run_for(200s);
  EXPECT_EQ(state(1), fed);
  EXPECT_EQ(noted_, vectors(20).size());
  EXPECT_THAT(written(), StartsWith(";^DF;!MC0;^PA;!VZ15;!ZM0;!PZ0,8388607;^PU"));
  EXPECT_THAT(written(), HasSubstr("^PU;^PU" + vectors(20).substr(from.offset + 2)));
}

TEST_F(MillContinuedTest, OnlyWhatWasConfirmedStarts) {
  raise_to_end();
  ASSERT_TRUE(confirm_as_shown(1));
  EXPECT_EQ(reason(mill_.start(1, prepared(), {.who = "unix anna"}, now_)), Reason::internal) << "from its beginning";
  const std::uint64_t elsewhere = jobs::offset_of(vectors(20), 1, 10);
  EXPECT_EQ(reason(start_rest(jobs::place_of(vectors(20), elsewhere))), Reason::internal);
}

TEST_F(MillContinuedTest, NoOtherJobIsConfirmedBeforeIt) {
  raise_to_end();
  add(2);
  const Result<void> other = confirm(2);
  EXPECT_EQ(reason(other), Reason::wrong_job_state);
  EXPECT_THAT(other.error().message,
              HasSubstr("job 1 (part.rml, by unix anna) is not finished: it continues at line 1"));
  ASSERT_TRUE(mill_.cancel(1, "unix anna", now_));
  EXPECT_TRUE(confirm(2));
}

TEST_F(MillContinuedTest, AVoidConfirmationLeavesItPaused) {
  raise_to_end();
  ASSERT_TRUE(confirm_as_shown(1));
  mill_.setup_changed("unix bert has moved the mill", now_);
  EXPECT_EQ(state(1), paused);
  EXPECT_TRUE(job(1).setup.from);
}

TEST_F(MillContinuedTest, APausedJobCanBeRaised) {
  begin();
  run_for(3s);
  ASSERT_TRUE(mill_.pause(false, now_));
  run_for(3s);
  EXPECT_THAT(written(), testing::Not(EndsWith(kLift)));
  ASSERT_TRUE(mill_.pause(true, now_));
  EXPECT_THAT(written(), EndsWith(kLift));
  run_for(60s);
  EXPECT_EQ(state(1), paused);
}

TEST_F(MillContinuedTest, APauseOfAPausedJobSaysThatItIsPaused) {
  const auto refusal = [this](bool raise) { return mill_.pause(raise, now_).error().message; };
  EXPECT_EQ(refusal(false), "no job is being sent");
  begin();
  run_for(3s);
  ASSERT_TRUE(mill_.pause(false, now_));
  EXPECT_EQ(refusal(false), "job 1 is paused already");
  ASSERT_TRUE(mill_.pause(true, now_));
  for (const bool raise : {false, true}) EXPECT_EQ(refusal(raise), "job 1 is being paused already");
  run_for(60s);
  ASSERT_EQ(state(1), paused);
  for (const bool raise : {false, true}) EXPECT_EQ(refusal(raise), "job 1 is paused already");
}

TEST_F(MillContinuedTest, AnAbortWhileTheToolRisesEndsTheJob) {
  raise();
  mill_.abort({.who = "unix bert"}, now_);
  run_for(1s);
  EXPECT_EQ(state(1), aborted);
}

TEST_F(MillContinuedTest, ALineThatIsLostWhileTheToolRises) {
  raise();
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(state(1), paused_unknown);
}

// A mill that takes no bytes, for instance because its panel stops it, has not executed them.
TEST_F(MillContinuedTest, AMillThatTakesNothingIsNotUp) {
  begin();
  run_for(3s);
  line_.busy = true;
  ASSERT_TRUE(mill_.pause(true, now_));
  run_for(120s);
  EXPECT_EQ(state(1), running);
  line_.busy = false;
  run_for(60s);
  EXPECT_EQ(state(1), paused);
}

TEST_F(MillContinuedTest, AtItsEndAJobIsNotRaised) {
  begin(1, 1);
  for (int i = 0; i < 60'000 && noted_ < vectors(1).size(); ++i) run_for(1ms);
  ASSERT_EQ(noted_, vectors(1).size());
  EXPECT_EQ(reason(mill_.pause(true, now_)), Reason::wrong_job_state);
  EXPECT_EQ(state(1), running);
  run_for(60s);
  EXPECT_EQ(state(1), fed);
}

TEST_F(MillContinuedTest, ALostJobGoesOnWhereSomebodyHasChosen) {
  begin();
  run_for(3s);
  const jobs::Place from{9, 1, 10};
  EXPECT_EQ(reason(mill_.choose_rest(1, {from}, "unix anna", now_)), Reason::wrong_job_state) << "it runs";
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(reason(mill_.choose_rest(2, {from}, "unix anna", now_)), Reason::not_found);
  EXPECT_EQ(reason(confirm_as_shown(1)), Reason::wrong_job_state);
  ASSERT_TRUE(mill_.choose_rest(1, {from}, "unix anna", now_));
  EXPECT_EQ(said_.back(), "PAUSED: it continues at line 1, column 10");
  EXPECT_EQ(by_[paused], "unix anna");
  ASSERT_TRUE(mill_.choose_rest(1, {{18, 1, 19}}, "unix anna", now_)) << "somebody has looked again";
  mill_.link_up(now_);
  run_for(1s);
  ASSERT_TRUE(confirm_as_shown(1));
  EXPECT_EQ(reason(start_rest(from)), Reason::internal);
  EXPECT_TRUE(start_rest({18, 1, 19}));
}

TEST_F(MillContinuedTest, WhatWasSentOfItIsKnownUntilItContinues) {
  raise_to_end();
  const jobs::Place from = *job(1).setup.from;
  const jobs::WrittenRange written{from.offset, from.offset};
  EXPECT_EQ(job(1).written, written);
  ASSERT_TRUE(mill_.choose_rest(1, {{9, 1, 10}}, "unix anna", now_));
  EXPECT_EQ(job(1).written, written) << "and not the place that was chosen";
  ASSERT_TRUE(confirm_as_shown(1));
  ASSERT_TRUE(start_rest({9, 1, 10}));
  EXPECT_EQ(job(1).written, std::nullopt);
}

TEST_F(MillContinuedTest, OfARestThatIsLostAtLeastWhatCameBeforeItWasSent) {
  raise_to_end();
  const jobs::Place from = *job(1).setup.from;
  ASSERT_TRUE(confirm_as_shown(1));
  ASSERT_TRUE(start_rest(from));
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(job(1).written->least, from.offset);
}

TEST_F(MillContinuedTest, OverARestart) {
  MillController after(profile_, settings_, line_, *this, permission_);
  jobs::Job paused_job{.number = 7, .name = "part.rml", .owner = "unix anna", .setup = setup(), .state = paused};
  paused_job.setup.from = jobs::Place{9, 1, 10};
  after.inherit(paused_job);
  after.link_up(now_);
  EXPECT_THAT(line_.writes, IsEmpty()) << "the tool is up";
  EXPECT_TRUE(after.confirm(7, after.jobs().front().setup, "unix bert", now_));
}

}  // namespace
}  // namespace axisgate::rml1::mill_continued_test
