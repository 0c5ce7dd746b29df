// Tests of jobs of several parts with tool changes between them, and of the state that a job leaves for later jobs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/mill/mill_controller.h"
#include "device/rml1/sending/commands.h"
#include "tests/rml1/fake_mill_line.h"
#include "tests/rml1/fake_permission.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using enum jobs::JobState;

// Parts of 24, 12 and 14 bytes, each lasting a few seconds by the profile.
constexpr std::string_view kPartBytes[] = {"V15;VS15;PU1000,0;PU0,0;", "V15;PU500,0;", "V15;PU0,500;;;"};
// Prologue and epilogue by test_profile(): Z rises with 15 mm/s, and its top is at 0.
constexpr std::string_view kPrologueBytes = ";^DF;", kEpilogueBytes = ";^PA;!VZ15;!ZM0;!MC0;^DF;!MC0;";

class MillPartsTest : public testing::Test, protected jobs::MachineEvents {
 protected:
  void SetUp() override { mill_.link_up(now_); }
  void TearDown() override { EXPECT_EQ(mill_.broken_invariant(), ""); }

  static jobs::Job job_in_parts(jobs::JobNumber number) {
    return {.number = number,
            .name = "part.rml",
            .owner = "unix anna",
            .setup = {"d", "test", "corner", "T1"},
            .bytes = 50,
            .parts = {{"T1", 24}, {"T3", 36}, {"T1", 50}}};
  }
  static jobs::Job job_that_leaves(jobs::JobNumber number, jobs::Leaves leaves) {
    return {.number = number,
            .name = "part.rml",
            .owner = "unix anna",
            .setup = {"d", "test", "corner", "T1"},
            .bytes = 24,
            .leaves = leaves};
  }
  static std::shared_ptr<const PreparedJob> prepared(std::size_t part) {
    constexpr std::uint64_t begins[] = {0, 24, 36};
    static const Profile profile = test_profile();
    return std::make_shared<const PreparedJob>(kPartBytes[part], "d", profile, std::nullopt, jobs::SendSettings(),
                                               begins[part]);
  }
  const jobs::Job& job(jobs::JobNumber number) const {
    static const jobs::Job none;
    for (const jobs::Job& one : mill_.jobs()) {
      if (one.number == number) return one;
    }
    ADD_FAILURE() << "there is no job " << number;
    return none;
  }
  Result<void> confirm(jobs::JobNumber number) { return mill_.confirm(number, job(number).setup, "unix bert", now_); }
  Result<void> start(jobs::JobNumber number, std::size_t part) {
    return mill_.start(number, prepared(part), {.who = "unix anna"}, now_);
  }
  void begin(jobs::JobNumber number, std::size_t part) {
    ASSERT_TRUE(confirm(number));
    ASSERT_TRUE(start(number, part));
  }
  // Runs until no job runs, for at most two minutes.
  void run_to_end() {
    for (const TimePoint end = now_ + 120s; now_ < end && mill_.running_job() != 0; now_ += 1ms) {
      line_.run_to(now_);
      if (const auto due = mill_.next_deadline(); due && *due <= now_) mill_.advance(now_);
    }
  }
  void feed(jobs::JobNumber number, std::size_t part) {
    begin(number, part);
    run_to_end();
  }
  std::string take_written() {
    std::string all;
    for (const std::string& one : std::exchange(line_.writes, {})) all += one;
    return all;
  }
  static Reason reason(const Result<void>& result) { return result ? Reason::unspecified : result.error().reason; }

  void link_changed(jobs::MachineLink, std::string_view, TimePoint) override {}
  void job_changed(const jobs::Job& job, std::string_view, std::string_view why, TimePoint) override {
    said_.push_back(std::string(name(job.state)) + (why.empty() ? "" : ": ") + std::string(why));
  }
  void rank_changed(const jobs::Job&) override {}
  void z0_sent(std::uint64_t) override {}
  void internal_error(std::string_view what, TimePoint) override { ADD_FAILURE() << what; }
  void sender_changed(const jobs::RunningJob&, TimePoint) override {}
  void written(std::string_view, jobs::JobNumber) override {}
  void abort_requested(std::string_view, TimePoint) override {}
  void about_to_write(jobs::JobNumber, const jobs::WrittenRange& sent) override { noted_.push_back(sent.most); }

  const Profile profile_ = test_profile();
  FakeMillLine line_;
  TimePoint now_{1000s};
  jobs::MachineSettings settings_;
  std::vector<std::string> said_;
  std::vector<std::uint64_t> noted_;
  FakePermission permission_;
  MillController mill_{profile_, settings_, line_, *this, permission_};
};

TEST_F(MillPartsTest, EachPartIsAJobInItselfAndToolsAreChangedBetween) {
  mill_.add(job_in_parts(1), now_);
  feed(1, 0);
  EXPECT_EQ(job(1).state, tool_change);
  EXPECT_EQ(job(1).part, 1u);
  EXPECT_EQ(job(1).setup.tool, "T3");
  EXPECT_EQ(take_written(), std::string(kPrologueBytes) + "V15;VS15;PU1000,0;PU0,0;" + std::string(kEpilogueBytes));
  feed(1, 1);
  EXPECT_EQ(job(1).setup.tool, "T1");
  EXPECT_EQ(take_written(), std::string(kPrologueBytes) + "V15;PU500,0;" + std::string(kEpilogueBytes));
  feed(1, 2);
  EXPECT_EQ(job(1).state, fed);
  EXPECT_EQ(take_written(), std::string(kPrologueBytes) + "V15;PU0,500;;;" + std::string(kEpilogueBytes));
  EXPECT_THAT(said_, ElementsAre("QUEUED", "CONFIRMED", "RUNNING", "TOOL_CHANGE: the next tool is T3", "CONFIRMED",
                                 "RUNNING", "TOOL_CHANGE: the next tool is T1", "CONFIRMED", "RUNNING", "FED"));
}

TEST_F(MillPartsTest, BetweenTwoPartsNobodyOccupiesTheMillAndNothingIsWritten) {
  mill_.add(job_in_parts(1), now_);
  begin(1, 0);
  EXPECT_EQ(permission_.users.size(), 1u);
  run_to_end();
  EXPECT_THAT(permission_.users, IsEmpty());
  take_written();
  EXPECT_EQ(reason(start(1, 1)), Reason::not_confirmed) << "it is not confirmed";
  EXPECT_FALSE(mill_.next_deadline());
  EXPECT_EQ(take_written(), "");
  EXPECT_TRUE(mill_.is_idle());
}

TEST_F(MillPartsTest, BytesAreThoseOfTheWholeJob) {
  mill_.add(job_in_parts(1), now_);
  feed(1, 0);
  EXPECT_EQ(noted_.front(), 0u) << "the prologue is none of the job's";
  EXPECT_EQ(noted_.back(), 24u);
  noted_.clear();
  begin(1, 1);
  EXPECT_EQ(mill_.running(now_)->progress.executed_least, 24u);
  EXPECT_EQ(mill_.running(now_)->progress.taken, 24u);
  EXPECT_EQ(noted_.front(), 24u);
  run_to_end();
  EXPECT_EQ(noted_.back(), 36u);
}

TEST_F(MillPartsTest, TheConfirmationIsForTheToolOfThePart) {
  mill_.add(job_in_parts(1), now_);
  const jobs::JobSetup first = job(1).setup;
  feed(1, 0);
  EXPECT_EQ(reason(mill_.confirm(1, first, "unix bert", now_)), Reason::setup_changed) << "T1 is out";
  EXPECT_EQ(job(1).state, tool_change);
  EXPECT_TRUE(confirm(1));
}

TEST_F(MillPartsTest, OnlyTheNextPartStarts) {
  mill_.add(job_in_parts(1), now_);
  feed(1, 0);
  ASSERT_TRUE(confirm(1));
  take_written();
  EXPECT_EQ(reason(start(1, 0)), Reason::internal);
  EXPECT_EQ(reason(start(1, 2)), Reason::internal);
  EXPECT_EQ(take_written(), "");
  EXPECT_TRUE(start(1, 1));
}

TEST_F(MillPartsTest, AVoidConfirmationLeadsBackToTheToolChange) {
  mill_.add(job_in_parts(1), now_);
  ASSERT_TRUE(confirm(1));
  mill_.setup_changed("unix bert has moved the mill", now_);
  EXPECT_EQ(job(1).state, queued) << "nothing of it was sent";
  feed(1, 0);
  ASSERT_TRUE(confirm(1));
  now_ += 10min;
  mill_.advance(now_);
  EXPECT_EQ(job(1).state, tool_change) << "expired";
  ASSERT_TRUE(confirm(1));
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(job(1).state, tool_change);
  EXPECT_EQ(job(1).part, 1u);
  EXPECT_FALSE(job(1).confirmation);
}

TEST_F(MillPartsTest, AnAbortInAToolChangeIsSentAndTheJobStays) {
  mill_.add(job_in_parts(1), now_);
  feed(1, 0);
  ASSERT_TRUE(confirm(1));
  take_written();
  EXPECT_TRUE(mill_.abort({.who = "unix carl"}, now_));
  EXPECT_EQ(take_written(), abort_commands(profile_, true));
  EXPECT_EQ(job(1).state, tool_change);
  EXPECT_EQ(reason(start(1, 1)), Reason::not_confirmed) << "its confirmation is void";
}

TEST_F(MillPartsTest, AnAbortOfALaterPartEndsTheJob) {
  mill_.add(job_in_parts(1), now_);
  feed(1, 0);
  begin(1, 1);
  mill_.abort({.who = "unix carl"}, now_);
  run_to_end();
  EXPECT_THAT(mill_.jobs(), IsEmpty());
  EXPECT_EQ(said_.back(),
            "ABORTED: the abort was sent; by the mill's profile what was executed of part 2 ends at line 1, column 1");
}

TEST_F(MillPartsTest, NoOtherJobIsConfirmedBetweenTwoParts) {
  mill_.add(job_in_parts(1), now_);
  mill_.add(job_that_leaves(2, {}), now_);
  feed(1, 0);
  const Result<void> second = confirm(2);
  EXPECT_EQ(reason(second), Reason::wrong_job_state);
  EXPECT_THAT(second.error().message, HasSubstr("job 1 (part.rml, by unix anna) is not finished: its next tool is T3"));
  ASSERT_TRUE(mill_.cancel(1, "unix anna", now_));
  EXPECT_EQ(said_.back(), "CANCELLED");
  EXPECT_TRUE(confirm(2));
}

TEST_F(MillPartsTest, ALaterPartThatWasConfirmedCanBeCancelled) {
  mill_.add(job_in_parts(1), now_);
  feed(1, 0);
  ASSERT_TRUE(confirm(1));
  EXPECT_TRUE(mill_.cancel(1, "unix anna", now_));
  EXPECT_THAT(mill_.jobs(), IsEmpty());
}

TEST_F(MillPartsTest, ALineThatIsLostInALaterPart) {
  mill_.add(job_in_parts(1), now_);
  feed(1, 0);
  begin(1, 1);
  mill_.link_down(now_, "unplugged");
  EXPECT_EQ(job(1).state, paused_unknown);
  EXPECT_EQ(job(1).written->least, 24u) << "the part before was executed";
  EXPECT_LE(job(1).written->most, 36u);
  EXPECT_EQ(reason(confirm(1)), Reason::wrong_job_state);
}

TEST_F(MillPartsTest, AnInheritedToolChangeIsConfirmedAndSendsNoAbort) {
  MillController after(profile_, settings_, line_, *this, permission_);
  jobs::Job job = job_in_parts(7);
  job.state = tool_change;
  go_to_part(job, 2);
  after.inherit(job);
  after.link_up(now_);
  EXPECT_EQ(take_written(), "");
  ASSERT_TRUE(after.confirm(7, after.jobs().front().setup, "unix bert", now_));
  EXPECT_TRUE(after.start(7, prepared(2), {.who = "unix anna"}, now_));
}

using MillLeavesTest = MillPartsTest;

TEST_F(MillLeavesTest, WhatAJobHasSetIsSeenBeforeTheNextIsConfirmed) {
  mill_.add(job_that_leaves(1, {.surface = true, .revolutions = true}), now_);
  mill_.add(job_that_leaves(2, {}), now_);
  mill_.add(job_that_leaves(3, {}), now_);
  jobs::JobSetup seen = job(2).setup;
  EXPECT_THAT(seen.left, IsEmpty());
  feed(1, 0);
  ASSERT_TRUE(mill_.done(1, "unix bert", now_));
  EXPECT_THAT(job(2).setup.left,
              ElementsAre("job 1 (part.rml) sets Z0", "job 1 (part.rml) sets the spindle speed (!RC)"));
  EXPECT_THAT(job(3).setup.left, IsEmpty()) << "job 2 is before it";
  const Result<void> unseen = mill_.confirm(2, seen, "unix bert", now_);
  EXPECT_EQ(reason(unseen), Reason::setup_changed);
  EXPECT_THAT(unseen.error().message, HasSubstr("job 1 (part.rml) sets Z0"));
  feed(2, 0);
  ASSERT_TRUE(mill_.done(2, "unix bert", now_));
  EXPECT_THAT(job(3).setup.left, IsEmpty()) << "job 2 was confirmed with it, and leaves nothing";
}

TEST_F(MillLeavesTest, TheNextJobIsTheOneThatComesFirst) {
  mill_.add(job_that_leaves(1, {.rotation = true}), now_);
  feed(1, 0);
  ASSERT_TRUE(mill_.done(1, "unix bert", now_));
  mill_.add(job_that_leaves(2, {}), now_);
  mill_.add(job_that_leaves(3, {}), now_);
  EXPECT_THAT(job(2).setup.left, ElementsAre("job 1 (part.rml) turns the rotary axis"));
  ASSERT_TRUE(confirm(2));
  ASSERT_TRUE(mill_.cancel(2, "unix anna", now_));
  EXPECT_THAT(job(3).setup.left, ElementsAre("job 1 (part.rml) turns the rotary axis"));
}

TEST_F(MillLeavesTest, AJobThatWasNotBegunLeavesNothing) {
  mill_.add(job_that_leaves(1, {.surface = true}), now_);
  mill_.add(job_that_leaves(2, {}), now_);
  ASSERT_TRUE(confirm(1));
  ASSERT_TRUE(mill_.cancel(1, "unix anna", now_));
  EXPECT_THAT(job(2).setup.left, IsEmpty());
}

TEST_F(MillLeavesTest, AnAbortedJobMayHaveSetIt) {
  mill_.add(job_that_leaves(1, {.surface = true}), now_);
  mill_.add(job_that_leaves(2, {}), now_);
  begin(1, 0);
  mill_.abort({.who = "unix bert"}, now_);
  run_to_end();
  EXPECT_THAT(job(2).setup.left, ElementsAre("job 1 (part.rml) sets Z0"));
}

TEST_F(MillLeavesTest, BetweenThePartsOfAJobItsToolIsWhatIsConfirmed) {
  jobs::Job first = job_in_parts(1);
  first.leaves.surface = true;
  mill_.add(first, now_);
  mill_.add(job_that_leaves(2, {}), now_);
  feed(1, 0);
  EXPECT_THAT(job(1).setup.left, IsEmpty());
  EXPECT_THAT(job(2).setup.left, IsEmpty()) << "it is not the next";
  ASSERT_TRUE(mill_.cancel(1, "unix anna", now_));
  EXPECT_THAT(job(2).setup.left, ElementsAre("job 1 (part.rml) sets Z0"));
}

TEST_F(MillLeavesTest, NoZ0IsLeftWhereAPersonHasSetIt) {
  MillController after(profile_, settings_, line_, *this, permission_);
  after.inherit_left(job_that_leaves(6, {.surface = true, .revolutions = true}));
  after.inherit(job_that_leaves(7, {}));
  after.link_up(now_);
  ASSERT_TRUE(after.operate(jobs::SetZ0{pulses(-800)}, {.who = "unix anna"}, now_));
  EXPECT_THAT(after.jobs().front().setup.left, ElementsAre("job 6 (part.rml) sets the spindle speed (!RC)"));
}

TEST_F(MillLeavesTest, AJobThatContinuesAWorkpieceNeedsItsZ0) {
  jobs::Job next = job_that_leaves(2, {});
  next.continues = 1;
  mill_.add(next, now_);
  ASSERT_TRUE(mill_.operate(jobs::SetZ0{pulses(-800)}, {.who = "unix anna"}, now_));
  const Result<void> confirmed = confirm(2);
  ASSERT_FALSE(confirmed);
  EXPECT_EQ(confirmed.error().reason, Reason::setup_changed);
  EXPECT_THAT(confirmed.error().message, HasSubstr("Z0 was sent to the mill since job 1 began"));
}

TEST_F(MillLeavesTest, OverARestart) {
  MillController after(profile_, settings_, line_, *this, permission_);
  after.inherit_left(job_that_leaves(6, {.surface = true}));
  after.inherit(job_that_leaves(7, {}));
  after.link_up(now_);
  EXPECT_THAT(after.jobs().front().setup.left, ElementsAre("job 6 (part.rml) sets Z0"));
}

TEST(JobPlan, IsThatOfItsPartAndCountsThoseBehindIt) {
  using std::chrono::seconds;
  jobs::Job job{.parts = {{"T1", 100, {seconds(1), seconds(2)}, {64, 100, seconds(3), 4}},
                          {"T2", 200, {seconds(10), seconds(20)}, {128, 100, seconds(3), 4}}}};
  EXPECT_EQ(takes(job), (jobs::TimeRange{seconds(11), seconds(22)}));
  EXPECT_EQ(run_on(job)->at_most, 64u);
  go_to_part(job, 1);
  EXPECT_EQ(takes(job), (jobs::TimeRange{seconds(10), seconds(20)}));
  EXPECT_EQ(run_on(job)->at_most, 128u);
  set_plan(job, {seconds(5), seconds(6)}, {256, 300, seconds(7), 8});
  EXPECT_EQ(takes(job), (jobs::TimeRange{seconds(5), seconds(6)}));
  EXPECT_EQ(run_on(job)->if_held, 300u);
  EXPECT_FALSE(run_on(jobs::Job{.parts = {{"T1", 100}}})) << "nobody has planned it";
}

}  // namespace
}  // namespace axisgate::rml1
