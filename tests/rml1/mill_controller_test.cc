// Tests of a mill's queue, of confirmations at the machine, and of the knowledge after a loss of the line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "device/rml1/sending/commands.h"
#include "tests/rml1/mill_controller_fixture.h"

namespace axisgate::rml1 {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using enum jobs::JobState;

TEST_F(MillControllerTest, AConfirmedJobIsSentWithPrologueAndEpilogueAndIsFed) {
  add(1);
  run_job(1, 4);
  EXPECT_EQ(state(1), running);
  run_for(60s);
  EXPECT_EQ(state(1), fed);
  EXPECT_EQ(written(), prologue() + vectors(4) + epilogue(profile_, true));
  EXPECT_TRUE(mill_.done(1, "unix bert", now_));
  EXPECT_EQ(state(1), done);
  EXPECT_THAT(mill_.jobs(), IsEmpty());
  EXPECT_EQ(
      by_,
      (std::map<jobs::JobState, std::string>{
          {queued, "unix anna"}, {confirmed, "unix bert"}, {running, "unix anna"}, {fed, ""}, {done, "unix bert"}}));
  EXPECT_THAT(said_, ElementsAre("QUEUED", "CONFIRMED", "RUNNING", "SENDING", "FINISHING", "FED", "FED", "DONE"));
}

TEST_F(MillControllerTest, WhoMayNotUseTheMillStartsAndResumesNothing) {
  add(1);
  ASSERT_TRUE(confirm(1));
  permission_.allowed = false;
  EXPECT_EQ(reason(mill_.start(1, prepared(), {.who = "unix anna", .lease = 9}, now_)), Reason::lease_held);
  EXPECT_THAT(line_.writes, IsEmpty());
  EXPECT_EQ(state(1), confirmed) << "it can be started by who may";
  EXPECT_EQ(permission_.asked.back().lease, 9);
  EXPECT_EQ(permission_.asked.back().scope, use::Scope::whole_device());
  permission_.allowed = true;
  ASSERT_TRUE(mill_.start(1, prepared(200), {.who = "unix anna"}, now_));
  ASSERT_TRUE(mill_.pause(false, now_));
  permission_.allowed = false;
  EXPECT_EQ(reason(mill_.resume({.who = "unix carl"}, now_)), Reason::lease_held);
}

TEST_F(MillControllerTest, AJobOccupiesTheMillUntilItHasEnded) {
  add(1);
  run_job(1, 4);
  EXPECT_EQ(permission_.users[1], "job 1 runs, part.rml, started by unix anna");
  run_for(60s);
  EXPECT_EQ(state(1), fed);
  EXPECT_THAT(permission_.users, IsEmpty());
}

TEST_F(MillControllerTest, WhoLosesTheRightHasTheJobAborted) {
  add(1);
  run_job(1, 200);
  permission_.orders.stops.push_back({7, use::Scope::whole_device(), "unix carl"});
  run_for(1s);
  EXPECT_EQ(state(1), aborted);
  EXPECT_EQ(by_[aborted], "unix carl");
  EXPECT_THAT(permission_.answered, ElementsAre(7));
  EXPECT_THAT(permission_.stops, IsEmpty()) << "nobody stopped it";
  EXPECT_TRUE(mill_.abort({.who = "unix bert"}, now_));
  EXPECT_THAT(permission_.stops, ElementsAre("unix bert"));
  EXPECT_EQ(aborts_requested_, 2);
}

TEST_F(MillControllerTest, WithoutAConfirmationNothingIsWritten) {
  add(1);
  EXPECT_EQ(reason(mill_.start(1, prepared(), {.who = "unix anna"}, now_)), Reason::not_confirmed);
  EXPECT_THAT(line_.writes, IsEmpty());
  EXPECT_EQ(state(1), queued);
}

TEST_F(MillControllerTest, AConfirmationExpires) {
  add(1);
  ASSERT_TRUE(confirm(1));
  now_ += 10min - 1ms;
  mill_.advance(now_);
  EXPECT_EQ(state(1), confirmed);
  now_ += 1ms;
  EXPECT_EQ(reason(mill_.start(1, prepared(), {.who = "unix anna"}, now_)), Reason::not_confirmed)
      << "also before time was let pass";
  mill_.advance(now_);
  EXPECT_EQ(state(1), queued);
  EXPECT_THAT(said_, Contains(HasSubstr("expired")));
}

TEST_F(MillControllerTest, AConfirmationIsForWhatTheJobNeeds) {
  add(1);
  for (const jobs::JobSetup& other :
       {jobs::JobSetup{"d2", "test", "corner", "T1"}, jobs::JobSetup{"d1", "mdx-15", "corner", "T1"},
        jobs::JobSetup{"d1", "test", "", "T1"}, jobs::JobSetup{"d1", "test", "corner", "T2"}}) {
    EXPECT_EQ(reason(mill_.confirm(1, other, "unix bert", now_)), Reason::setup_changed);
  }
  EXPECT_EQ(state(1), queued);
}

TEST_F(MillControllerTest, OtherBytesThanThoseConfirmedDoNotStart) {
  add(1);
  ASSERT_TRUE(confirm(1));
  EXPECT_EQ(reason(mill_.start(1, prepared(20, "d2"), {.who = "unix anna"}, now_)), Reason::internal);
  EXPECT_THAT(line_.writes, IsEmpty());
}

TEST_F(MillControllerTest, OnlyTheFirstOfTheQueueIsConfirmed) {
  add(1);
  add(2, "unix carla");
  const Result<void> second = confirm(2);
  EXPECT_EQ(reason(second), Reason::wrong_job_state);
  EXPECT_THAT(second.error().message, HasSubstr("job 1 (part.rml, by unix anna) is before"));
  EXPECT_EQ(reason(confirm(3)), Reason::not_found);
  ASSERT_TRUE(mill_.cancel(1, "unix bert", now_));
  EXPECT_TRUE(confirm(2));
}

TEST_F(MillControllerTest, WhileItIsNotKnownWhatBecameOfAJobNoOtherStarts) {
  add(1);
  add(2);
  run_job(1, 4);
  run_for(60s);
  ASSERT_EQ(state(1), fed);
  const Result<void> second = confirm(2);
  EXPECT_EQ(reason(second), Reason::wrong_job_state);
  EXPECT_THAT(second.error().message, HasSubstr("job 1 (part.rml, by unix anna) is FED"));
  ASSERT_TRUE(mill_.done(1, "unix bert", now_));
  run_job(2, 200);
  mill_.link_down(now_, "unplugged");
  mill_.link_up(now_);
  add(3);
  EXPECT_EQ(reason(confirm(3)), Reason::wrong_job_state);
  ASSERT_TRUE(mill_.cancel(2, "unix bert", now_));
  EXPECT_TRUE(confirm(3));
}

TEST_F(MillControllerTest, AnAbortWithoutAJobLeavesAlsoWhereTheMillHoldsTheLine) {
  line_.busy = true;
  EXPECT_TRUE(mill_.abort({.who = "unix bert"}, now_));
  EXPECT_FALSE(mill_.is_idle());
  run_for(1s);
  EXPECT_EQ(line_.received, abort_commands(profile_, true));
  EXPECT_TRUE(mill_.is_idle());
  EXPECT_FALSE(line_.ignores);
}

TEST_F(MillControllerTest, AJogAnAbortAndALostLineVoidAConfirmation) {
  add(1);
  ASSERT_TRUE(confirm(1));
  mill_.setup_changed("unix bert has moved the mill", now_);
  EXPECT_EQ(reason(mill_.start(1, prepared(), {.who = "unix anna"}, now_)), Reason::not_confirmed);
  ASSERT_TRUE(confirm(1));
  mill_.abort({.who = "unix bert"}, now_);
  EXPECT_EQ(reason(mill_.start(1, prepared(), {.who = "unix anna"}, now_)), Reason::not_confirmed);
  run_for(1s);
  ASSERT_TRUE(confirm(1));
  mill_.link_down(now_, "unplugged");
  mill_.link_up(now_);
  EXPECT_EQ(reason(mill_.start(1, prepared(), {.who = "unix anna"}, now_)), Reason::not_confirmed);
  EXPECT_THAT(line_.writes, ElementsAre(abort_commands(profile_, true)));
}

TEST_F(MillControllerTest, AnAbortIsSentAlsoWhereNoJobRuns) {
  mill_.link_down(now_, "unplugged");
  EXPECT_FALSE(mill_.abort({.who = "unix bert"}, now_));
  EXPECT_THAT(line_.writes, IsEmpty());
  mill_.link_up(now_);
  EXPECT_THAT(line_.writes, ElementsAre(abort_commands(profile_, true))) << "when the line is back";
  mill_.abort({.who = "unix bert"}, now_);
  EXPECT_THAT(line_.writes, SizeIs(2));
  EXPECT_EQ(aborts_requested_, 2) << "what was sent when the line was back is no request";
}

TEST_F(MillControllerTest, WhileAJobRunsNoneIsConfirmedOrStarted) {
  add(1);
  add(2);
  run_job(1);
  EXPECT_EQ(reason(confirm(2)), Reason::wrong_job_state);
  EXPECT_EQ(reason(mill_.start(2, prepared(), {.who = "unix anna"}, now_)), Reason::wrong_job_state);
  EXPECT_EQ(reason(mill_.cancel(1, "unix bert", now_)), Reason::wrong_job_state) << "it is aborted, not cancelled";
}

TEST_F(MillControllerTest, PauseAndResume) {
  add(1);
  EXPECT_EQ(reason(mill_.pause(false, now_)), Reason::wrong_job_state);
  run_job(1);
  EXPECT_EQ(reason(mill_.resume({.who = "unix anna"}, now_)), Reason::wrong_job_state);
  run_for(2s);
  ASSERT_TRUE(mill_.pause(false, now_));
  const std::size_t before = line_.writes.size();
  run_for(60s);
  EXPECT_THAT(line_.writes, SizeIs(before));
  ASSERT_TRUE(mill_.resume({.who = "unix anna"}, now_));
  run_for(120s);
  EXPECT_EQ(state(1), fed);
}

TEST_F(MillControllerTest, AnAbortEndsTheJobAndVoidsNothingElse) {
  add(1);
  add(2);
  run_job(1);
  run_for(2s);
  const std::size_t before = line_.writes.size();
  mill_.abort({.who = "unix bert"}, now_);
  run_for(1s);
  EXPECT_EQ(state(1), aborted);
  EXPECT_EQ(by_[aborted], "unix bert");
  EXPECT_THAT(line_.writes, SizeIs(before + 1));
  EXPECT_THAT(line_.writes.back(), HasSubstr("\x1B.K\x1B.K"));
  EXPECT_EQ(mill_.jobs().front().number, 2u);
}

TEST_F(MillControllerTest, WhatIsWrittenIsNotedBefore) {
  add(1);
  run_job(1);
  EXPECT_EQ(written_before_note_ + 1, line_.writes.size());
  run_for(3s);
  EXPECT_EQ(noted_, mill_.running(now_)->progress.written);
  EXPECT_GT(noted_, 0u);
}

TEST_F(MillControllerTest, ALostLineLeavesARangeAndResumesNothing) {
  add(1);
  run_job(1, 200);
  run_for(20s);
  const std::uint64_t most = mill_.running(now_)->progress.written;
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(state(1), paused_unknown);
  EXPECT_EQ(mill_.jobs().front().written->most, most);
  EXPECT_EQ(mill_.jobs().front().written->least, most - std::min<std::uint64_t>(most, 512));
  line_.writes.clear();
  mill_.link_up(now_);
  run_for(60s);
  EXPECT_THAT(line_.writes, ElementsAre(abort_commands(profile_, true))) << "the mill is stopped once, nothing else";
  EXPECT_EQ(reason(mill_.start(1, prepared(200), {.who = "unix anna"}, now_)), Reason::not_confirmed);
  EXPECT_EQ(reason(confirm(1)), Reason::wrong_job_state);
  EXPECT_TRUE(mill_.cancel(1, "unix bert", now_));
}

TEST_F(MillControllerTest, AnAbortThatWaitedWhenTheDaemonEndedIsSent) {
  mill_.link_down(now_, "unplugged");
  EXPECT_FALSE(mill_.abort_waits());
  EXPECT_FALSE(mill_.abort({.who = "unix bert"}, now_));
  EXPECT_TRUE(mill_.abort_waits());
  MillController after(profile_, settings_, line_, *this, permission_);
  after.inherit_abort();
  line_.writes.clear();
  after.link_up(now_);
  EXPECT_THAT(line_.writes, ElementsAre(abort_commands(profile_, true)));
  EXPECT_TRUE(after.abort_waits()) << "it has not left this host";
  line_.run_to(now_ + 1s);
  after.advance(now_ + 1s);
  EXPECT_FALSE(after.abort_waits());
}

// The abort may still have been in the host, or in a converter of 512 bytes: 0.53 s at 9600 baud.
TEST_F(MillControllerTest, AnAbortThatTheLineMayHaveLostIsSentAgain) {
  settings_.at_loss = jobs::AtLoss::leave;
  MillController mill(profile_, settings_, line_, *this, permission_);
  const auto sent_after = [&](Duration time) {
    mill.link_up(now_);
    line_.writes.clear();
    mill.abort({.who = "unix bert"}, now_);
    for (const TimePoint end = now_ + time; now_ < end; now_ += 1ms) {
      line_.run_to(now_);
      if (const auto due = mill.next_deadline(); due && *due <= now_) mill.advance(now_);
    }
    mill.link_down(now_, "unplugged");
    line_.run_to(now_ += 1s);
    mill.link_up(now_);
    line_.run_to(now_ += 1s);
    mill.advance(now_);
    mill.link_down(now_ += 1s, "unplugged");
    return line_.writes.size();
  };
  EXPECT_EQ(sent_after(10ms), 2u) << "it had not left the host";
  EXPECT_EQ(sent_after(400ms), 2u) << "it may have been in the converter";
  EXPECT_EQ(sent_after(700ms), 1u);
}

TEST_F(MillControllerTest, TheAbortOfAJobThatTheLineMayHaveLostIsSentAgain) {
  add(1);
  run_job(1, 200);
  run_for(5s);
  ASSERT_TRUE(mill_.abort({.who = "unix bert"}, now_));
  run_for(200ms);
  ASSERT_EQ(state(1), aborted);
  mill_.link_down(now_, "unplugged");
  line_.writes.clear();
  mill_.link_up(now_);
  EXPECT_THAT(line_.writes, ElementsAre(abort_commands(profile_, true)));
}

TEST_F(MillControllerTest, AJobOfAKilledDaemonIsStoppedWhenTheLineOpens) {
  MillController after(profile_, settings_, line_, *this, permission_);
  after.inherit({.number = 7,
                 .name = "part.rml",
                 .owner = "unix anna",
                 .setup = setup(),
                 .state = paused_unknown,
                 .written = jobs::WrittenRange{0, 900}});
  EXPECT_EQ(after.jobs().front().state, paused_unknown);
  after.link_up(now_);
  EXPECT_THAT(line_.writes, ElementsAre(abort_commands(profile_, true)));
  line_.run_to(now_ += 1s);
  after.advance(now_);
  after.link_down(now_ += 1s, "unplugged");
  after.link_up(now_);
  EXPECT_THAT(line_.writes, SizeIs(1)) << "once";
}

TEST_F(MillControllerTest, AtLossLeaveSendsNothing) {
  settings_.at_loss = jobs::AtLoss::leave;
  MillController other(profile_, settings_, line_, *this, permission_);
  other.inherit({.number = 7, .name = "part.rml", .owner = "unix anna", .setup = setup(), .state = paused_unknown});
  other.link_up(now_);
  EXPECT_THAT(line_.writes, IsEmpty());
}

// `leave` applies to jobs whose line was lost, not to an abort that a person requested.
TEST_F(MillControllerTest, AtLossLeaveSendsAnAbortThatTheRunBeforeCouldNotSend) {
  settings_.at_loss = jobs::AtLoss::leave;
  MillController other(profile_, settings_, line_, *this, permission_);
  other.inherit_abort();
  other.inherit({.number = 7, .name = "part.rml", .owner = "unix anna", .setup = setup(), .state = paused_unknown});
  other.link_up(now_);
  EXPECT_EQ(written(), abort_commands(profile_, true));
}

TEST_F(MillControllerTest, AMillThatTakesNothingIsBusyAndNotGone) {
  add(1);
  run_job(1, 200);
  run_for(5s);
  line_.busy = true;
  run_for(10min - 5s);
  EXPECT_FALSE(mill_.running(now_)->busy);
  run_for(10s);
  EXPECT_TRUE(mill_.running(now_)->busy);
  EXPECT_EQ(state(1), running);
  line_.busy = false;
  run_for(1s);
  EXPECT_FALSE(mill_.running(now_)->busy);
}

// All bytes have been written, and CTS is low.
TEST_F(MillControllerTest, AMillThatKeepsTheLineAtTheEndIsBusyAndNotFed) {
  add(1);
  run_job(1, 2);
  while (mill_.running(now_)->sender == jobs::SenderState::sending) run_for(1ms);
  line_.busy = true;
  run_for(11min);
  EXPECT_EQ(state(1), running);
  EXPECT_TRUE(mill_.running(now_)->busy);
  line_.busy = false;
  run_for(10s);
  EXPECT_EQ(state(1), fed);
}

TEST_F(MillControllerTest, WithAClosedLineNothingIsConfirmed) {
  add(1);
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(reason(confirm(1)), Reason::link_down);
}

// The prologue is ";^DF;", so five bytes do not belong to the job.
TEST(PreparedJobTest, BytesOfTheTextAndOfTheJob) {
  const Profile profile = test_profile();
  const PreparedJob job("PU1000,0;", "d", profile, std::nullopt, {});
  EXPECT_EQ(job.text(), ";^DF;PU1000,0;" + epilogue(profile, true)) << "PU starts a spindle that DF permits";
  EXPECT_EQ(job.of_body(0), 0u);
  EXPECT_EQ(job.of_body(5), 0u);
  EXPECT_EQ(job.of_body(8), 3u);
  EXPECT_EQ(job.of_body(job.text().size()), 9u);
}

}  // namespace
}  // namespace axisgate::rml1
