// The record that a killed daemon leaves of the job that it was sending.
#include "server/devices/job_record.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

#include "device/rml1/model.h"
#include "server/devices/spooled_jobs.h"
#include "server/events/wall_time.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server {
namespace {

using jobs::JobState;
constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();

// A job of two parts: 300 bytes, then 200.
jobs::Job job(jobs::JobNumber number = 7, JobState state = JobState::running) {
  return {.number = number,
          .name = "part.rml",
          .owner = "unix anna",
          .setup = {"d", "mdx-20", "", "T1"},
          .bytes = 500,
          .state = state,
          .parts = {{"T1", 300}, {"T3", 500}}};
}

class JobRecordTest : public testing::Test {
 protected:
  std::unique_ptr<JobRecord> open(std::string_view boot = "this boot") const { return *JobRecord::open(path_, boot); }

  const link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "job-mill";
};

TEST_F(JobRecordTest, HasNothingBeforeTheFirstJob) {
  EXPECT_FALSE(open()->before());
  EXPECT_FALSE(open()->before());
}

TEST_F(JobRecordTest, KeepsHowFarTheLastJobMayHaveGone) {
  {
    const auto record = open();
    record->begin(job());
    record->going_to({0, 40});
    record->going_to({21, 52});
  }
  const auto before = open()->before();
  ASSERT_TRUE(before);
  EXPECT_EQ(before->sent_least, 21u) << "so it is known after a kill, too";
  EXPECT_EQ(before->job, 7u);
  EXPECT_EQ(before->state, JobState::running);
  EXPECT_EQ(before->through, 52u);
}

TEST_F(JobRecordTest, ANewJobBeginsAtItsFirstByte) {
  const auto record = open();
  record->begin(job());
  record->going_to({0, 52});
  record->set_state(job(7, JobState::fed));
  record->begin(job(8));
  const auto before = open()->before();
  EXPECT_EQ(before->job, 8u);
  EXPECT_EQ(before->state, JobState::running);
  EXPECT_EQ(before->through, 0u);
}

TEST_F(JobRecordTest, KeepsWhereItContinues) {
  jobs::Job paused = job(7, JobState::paused);
  const auto record = open();
  record->begin(paused);
  paused.setup.from = jobs::Place{20, 2, 5};
  record->set_state(paused);
  EXPECT_EQ(open()->before()->from, 20u);
  record->begin(job());
  EXPECT_EQ(open()->before()->from, 0u);
}

// The spool may have deleted the job by then.
TEST_F(JobRecordTest, KeepsWhatTheLastJobLeaves) {
  jobs::Job last = job();
  last.name = std::string(100, 'n');
  for (const jobs::Leaves leaves :
       {jobs::Leaves(), jobs::Leaves{.surface = true}, jobs::Leaves{.revolutions = true},
        jobs::Leaves{.rotation = true}, jobs::Leaves{.tool = true}, jobs::Leaves{true, true, true, true}}) {
    last.leaves = leaves;
    open()->begin(last);
    EXPECT_EQ(open()->before()->leaves, leaves);
  }
  EXPECT_EQ(open()->before()->name, last.name);
}

TEST_F(JobRecordTest, KeepsThatAnAbortWaits) {
  const auto record = open();
  EXPECT_FALSE(open()->abort_waited());
  record->set_abort_waits(true);
  EXPECT_TRUE(open()->abort_waited());
  record->set_abort_waits(false);
  EXPECT_FALSE(open()->abort_waited());
}

TEST_F(JobRecordTest, KeepsHowOftenZ0WasSent) {
  EXPECT_EQ(open()->z0_count(), 1'000'000u) << "a first boot";
  open()->set_z0_count(7);
  EXPECT_EQ(open()->z0_count(), 7u);
  EXPECT_GT(open("another boot")->z0_count(), 7u) << "a count may have been lost with the machine";
}

TEST_F(JobRecordTest, StatesAreThoseOfTheLastJob) {
  const auto record = open();
  record->begin(job());
  record->set_state(job(9, JobState::cancelled));
  EXPECT_EQ(open()->before()->state, JobState::running);
  record->set_state(job(7, JobState::aborted));
  EXPECT_EQ(open()->before()->state, JobState::aborted);
}

TEST_F(JobRecordTest, ALaterPartBeginsAtItsFirstByte) {
  const auto record = open();
  jobs::Job later = job();
  record->begin(later);
  record->going_to({0, 300});
  go_to_part(later, 1);
  later.state = JobState::tool_change;
  record->set_state(later);
  EXPECT_EQ(open()->before()->state, JobState::tool_change);
  EXPECT_EQ(open()->before()->part, 1u);
  record->begin(later);
  EXPECT_EQ(open()->before()->state, JobState::running);
  EXPECT_EQ(open()->before()->through, 300u);
  EXPECT_EQ(open()->before()->part, 1u);
}

TEST_F(JobRecordTest, AfterABootOfTheMachineAnyByteMayHaveGone) {
  {
    const auto record = open();
    record->begin(job());
    record->going_to({0, 52});
  }
  EXPECT_EQ(open("another boot")->before()->through, kAll);
  EXPECT_EQ(open("another boot")->before()->through, kAll) << "also for the second run after it";
}

TEST_F(JobRecordTest, AnotherFileIsNoRecord) {
  std::ofstream(path_) << std::string(200, 'x');
  EXPECT_FALSE(open()->before());
}

TEST_F(JobRecordTest, WhatCannotBeMadeIsSaid) { EXPECT_FALSE(JobRecord::open("/proc/job", "this boot")); }

TEST(JobAsItWasLeft, WhatMayHaveGoneIsWithinTheJob) {
  jobs::Job left = as_it_was_left(job(), {7, JobState::running, 52});
  EXPECT_EQ(left.state, JobState::paused_unknown);
  EXPECT_EQ(left.written, (jobs::WrittenRange{0, 52}));
  left = as_it_was_left(job(), {7, JobState::running, kAll});
  EXPECT_EQ(left.written, (jobs::WrittenRange{0, 500}));
}

TEST(JobAsItWasLeft, ALaterPartThatMayHaveBegun) {
  jobs::Job left = as_it_was_left(job(), {7, JobState::running, 352, 1, 300, 300});
  EXPECT_EQ(left.state, JobState::paused_unknown);
  EXPECT_EQ(left.written, (jobs::WrittenRange{300, 352})) << "the part before was executed";
  EXPECT_EQ(left.setup.tool, "T3");
}

TEST(JobAsItWasLeft, AToolChangeIsOneAndItsConfirmationIsVoid) {
  for (const JobState state : {JobState::tool_change, JobState::confirmed}) {
    const jobs::Job left = as_it_was_left(job(), {7, state, 300, 1, 300});
    EXPECT_EQ(left.state, JobState::tool_change);
    EXPECT_EQ(left.part, 1u);
    EXPECT_EQ(left.setup.tool, "T3");
    EXPECT_FALSE(left.written);
  }
}

TEST(JobAsItWasLeft, WhatWasPausedGoesOnAtItsPlace) {
  jobs::Job before = job();
  go_to_part(before, 1);
  before.setup.from = jobs::Place{20, 2, 5};
  for (const JobState state : {JobState::paused, JobState::confirmed}) {
    const jobs::Job left = as_it_was_left(before, {7, state, 320, 1, 320});
    EXPECT_EQ(left.state, JobState::paused);
    EXPECT_EQ(left.setup.from, before.setup.from);
    EXPECT_FALSE(left.written);
  }
  const jobs::Job lost = as_it_was_left(before, {7, JobState::running, 352, 1, 320, 320});
  EXPECT_EQ(lost.state, JobState::paused_unknown);
  EXPECT_EQ(lost.written, (jobs::WrittenRange{320, 352})) << "what comes before it was executed";
  EXPECT_EQ(as_it_was_left(before, {7, JobState::tool_change, 400, 0}).setup.from, std::nullopt) << "of another part";
}

// The daemon was killed before the place was in the spool.
TEST(JobAsItWasLeft, WhatWasPausedAtAPlaceThatIsNotKnown) {
  const jobs::Job left = as_it_was_left(job(), {7, JobState::paused, 52, 0, 52, 52});
  EXPECT_EQ(left.state, JobState::paused_unknown);
  EXPECT_EQ(left.written, (jobs::WrittenRange{52, 52}));
}

// The mill may not have received everything before the place that a person has chosen.
TEST_F(JobRecordTest, AChosenPlaceThatIsNotInTheSpoolSaysNothingOfWhatWasSent) {
  jobs::Job lost = job();
  {
    const auto record = open();
    record->begin(lost);
    record->going_to({0, 52});
    lost.state = JobState::paused;
    lost.written = jobs::WrittenRange{10, 52};
    lost.setup.from = jobs::Place{40, 4, 1};
    record->set_state(lost);
  }
  const jobs::Job left = as_it_was_left(job(), *open()->before());
  EXPECT_EQ(left.state, JobState::paused_unknown);
  EXPECT_EQ(left.written, (jobs::WrittenRange{10, 52}));
}

// The place in the spool is from an earlier pause.
TEST(JobAsItWasLeft, WhatWasPausedAtAnotherPlaceThanTheOneThatIsKnown) {
  jobs::Job before = job();
  before.setup.from = jobs::Place{20, 2, 5};
  for (const JobState state : {JobState::paused, JobState::confirmed}) {
    const jobs::Job left = as_it_was_left(before, {7, state, 52, 0, 52, 52});
    EXPECT_EQ(left.state, JobState::paused_unknown);
    EXPECT_EQ(left.written, (jobs::WrittenRange{52, 52}));
  }
}

TEST(JobAsItWasLeft, WhatWasFedIsFed) {
  const jobs::Job left = as_it_was_left(job(), {7, JobState::fed, 500});
  EXPECT_EQ(left.state, JobState::fed);
  EXPECT_FALSE(left.written);
}

spool::Job spooled(const jobs::Job& job) {
  return {.id = 3,
          .name = "part.rml",
          .who = "unix anna",
          .bytes = 500,
          .sha256 = "d",
          .created = calendar_now() - std::chrono::days(2),
          .facts = facts_of(job)};
}

constexpr jobs::TimeRange kTakes{std::chrono::milliseconds(1500), std::chrono::hours(2)};
constexpr jobs::RunOn kRunOn{1540, 1600, std::chrono::milliseconds(1234), 12.5};

TEST(JobOfTheSpool, HasItsSetupAndItsTime) {
  const jobs::Job made = job_of(spooled({.setup = {"", "mdx-20", "corner", ""},
                                         .parts = {{"T2", 500, kTakes, kRunOn}},
                                         .leaves = {.surface = true, .tool = true}}));
  EXPECT_EQ(made.number, 3u);
  EXPECT_EQ(made.owner, "unix anna");
  EXPECT_EQ(made.setup, (jobs::JobSetup{"d", "mdx-20", "corner", "T2"}));
  EXPECT_EQ(made.bytes, 500u);
  EXPECT_EQ(made.parts.at(0).takes, kTakes);
  EXPECT_EQ(jobs::run_on(made), kRunOn);
  EXPECT_EQ(jobs::run_on(job_of({.id = 5, .facts = R"({"parts":[{"tool":"T1","end":9,"takes_ns":["a",null]}]})"})),
            std::nullopt);
  EXPECT_EQ(made.state, JobState::queued);
  EXPECT_EQ(made.leaves, (jobs::Leaves{.surface = true, .tool = true}));
  EXPECT_EQ(std::chrono::round<std::chrono::hours>(monotonic_now() - made.queued_since), std::chrono::hours(48));
  EXPECT_EQ(job_of({.id = 4, .facts = "damaged"}).setup.tool, "");
}

TEST(JobOfTheSpool, HasItsSizeAndWhatWasAccepted) {
  jobs::Job sent = job();
  EXPECT_FALSE(job_of(spooled(sent)).extent.driven.z.any);
  const jobs::Reach x{true, -1.5, 38}, y{true, 0, 30}, z{true, -1.7, 2};
  sent.extent = {{x, y, z}, {x, y, {true, -1.7, 0}}};
  sent.accepted = {"deep-pass", "tool-left-down"};
  const jobs::Job made = job_of(spooled(sent));
  EXPECT_EQ(jobs::size_text(made.extent), "39.5 x 30.0 mm, 1.70 mm deep");
  EXPECT_EQ(made.extent.driven.z.highest, 2);
  EXPECT_EQ(made.accepted, sent.accepted);
  const jobs::Job damaged =
      job_of({.id = 4, .facts = R"({"accepted":["all",3],"cut_mm":[[1],"a",[1,"b"]],"driven_mm":7})"});
  EXPECT_EQ(damaged.accepted, std::vector<std::string>{"all"}) << "a check without such a warning ignores it";
  EXPECT_FALSE(damaged.extent.cut.x.any || damaged.extent.driven.z.any);
}

TEST(JobOfTheSpool, KnowsHowItIsSent) {
  jobs::Job sent = job();
  EXPECT_EQ(job_of(spooled(sent)).streaming, std::nullopt);
  for (const auto streaming : {jobs::Streaming::paced, jobs::Streaming::full}) {
    sent.streaming = streaming;
    EXPECT_EQ(job_of(spooled(sent)).streaming, streaming);
  }
}

TEST(JobOfTheSpool, KnowsItsWorkpieceAndWhatItWasCheckedFor) {
  jobs::Job sent = job();
  sent.stock = jobs::Stock{80, 50, 10.5};
  sent.checked_for = "c1";
  EXPECT_EQ(job_of(spooled(sent)).stock, sent.stock);
  EXPECT_EQ(job_of(spooled(sent)).checked_for, "c1");
}

TEST(CheckedFor, IsTheProfileAndWhereTheOriginIs) {
  const auto model_of = [](std::string text) {
    return std::make_shared<const rml1::MillModel>("mdx-20", std::move(text), rml1::Profile{},
                                                   std::vector<rml1::KnownMachine>());
  };
  MillConfig config;
  config.model = model_of("p1");
  config.origins = {{.name = "vice", .x = 1, .y = 2}};
  const std::string vice = checked_for(config, "vice"), panel = checked_for(config, "");
  EXPECT_NE(vice, panel);
  config.origins[0].z = -800;
  EXPECT_NE(checked_for(config, "vice"), vice);
  EXPECT_EQ(checked_for(config, ""), panel);
  config.model = model_of("p2");
  EXPECT_NE(checked_for(config, ""), panel);
}

TEST(JobOfTheSpool, KnowsWhereItGoesOn) {
  jobs::Job left = job();
  left.setup.from = jobs::Place{20, 2, 5};
  EXPECT_EQ(job_of(spooled(left)).setup.from, (jobs::Place{20, 2, 5}));
  EXPECT_EQ(job_of(spooled(left)).state, JobState::queued) << "the rest of another job, which has not begun";
  left.written = jobs::WrittenRange{20, 20};
  EXPECT_EQ(job_of(spooled(left)).state, JobState::paused);
}

TEST(JobOfTheSpool, KnowsOnWhoseWorkpieceItGoesOn) {
  jobs::Job sent = job();
  EXPECT_EQ(job_of(spooled(sent)).continues, 0u);
  sent.continues = 3;
  sent.z0_count = 5;
  EXPECT_EQ(job_of(spooled(sent)).continues, 3u);
  EXPECT_EQ(job_of(spooled(sent)).z0_count, 5u);
}

TEST(JobOfTheSpool, KnowsHowFarOneThatContinuesWasSent) {
  jobs::Job left = job();
  left.written = jobs::WrittenRange{30, 40};
  EXPECT_FALSE(job_of(spooled(left)).written) << "it begins at its beginning";
  left.setup.from = jobs::Place{20, 2, 5};
  EXPECT_EQ(job_of(spooled(left)).written, left.written);
  EXPECT_EQ(as_it_was_left(job_of(spooled(left)), {7, JobState::paused, 40, 0, 20}).written, left.written);
  EXPECT_EQ(as_it_was_left(job_of(spooled(left)), {7, JobState::tool_change, 300, 1, 300}).written, std::nullopt);
}

TEST(JobOfTheSpool, HasItsPlaceInTheQueue) {
  jobs::Job moved = job();
  EXPECT_EQ(job_of(spooled(moved)).rank, 0);
  moved.rank = -2;
  EXPECT_EQ(job_of(spooled(moved)).rank, -2);
}

// If the record of what was sent is lost, no part is cut twice.
TEST(JobOfTheSpool, KnowsItsNextPart) {
  jobs::Job left = job();
  EXPECT_EQ(job_of(spooled(left)).parts, left.parts);
  EXPECT_EQ(job_of(spooled(left)).state, JobState::queued);
  go_to_part(left, 1);
  EXPECT_EQ(job_of(spooled(left)).state, JobState::tool_change);
  EXPECT_EQ(job_of(spooled(left)).part, 1u);
  EXPECT_EQ(job_of(spooled(left)).setup.tool, "T3");
}

}  // namespace
}  // namespace axisgate::server
