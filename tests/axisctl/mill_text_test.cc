// Tests of axisctl's texts about a mill's jobs. Numbers are typed by hand: 12,300 of 30,000 bytes are 41 %.
#include "clients/axisctl/mill/mill_text.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/time_util.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <time.h>

#include <string>
#include <vector>

#include "tests/axisctl/cut_out.h"
#include "tests/axisctl/executed_lines.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::util::TimeUtil;
using testing::Contains;
using testing::HasSubstr;
using Lines = std::vector<std::string>;

v1::Job frame(int number, v1::JobState state) {
  v1::Job job;
  job.set_name("devices/mill/jobs/" + std::to_string(number));
  job.set_title("frame.rml");
  job.mutable_owner()->set_name("unix anna");
  job.mutable_setup()->set_digest("3f5a9c001b2d77");
  job.mutable_setup()->set_profile("MDX-20");
  job.mutable_setup()->set_tool("T1");
  job.set_bytes(30'000);
  job.set_part(1);
  *job.mutable_shortest_time() = TimeUtil::SecondsToDuration(600);
  *job.mutable_longest_time() = TimeUtil::SecondsToDuration(1000);
  job.set_state(state);
  return job;
}

// Sets the remaining time of a job that takes 600 to 1000 s for 30,000 bytes.
void set_left(v1::RunningJob& running, std::int64_t executed_least, std::int64_t executed_most) {
  const auto left = [](std::int64_t ms_a_byte, std::int64_t executed) {
    return TimeUtil::MillisecondsToDuration(ms_a_byte * (30'000 - std::clamp<std::int64_t>(executed, 0, 30'000)));
  };
  *running.mutable_shortest_remaining_time() = left(20, executed_most);
  *running.mutable_longest_remaining_time() =
      TimeUtil::MillisecondsToDuration(TimeUtil::DurationToMilliseconds(left(100, executed_least)) / 3);
}

v1::RunningJob running(std::int64_t written, std::int64_t executed_least, std::int64_t executed_most) {
  v1::RunningJob running;
  set_left(running, executed_least, executed_most);
  running.set_job("devices/mill/jobs/7");
  running.set_sending(v1::SENDING_STATE_SENDING);
  running.set_written(written);
  running.set_taken(executed_least);
  running.set_executed_least(executed_least);
  running.set_executed_most(executed_most);
  return running;
}

v1::RunOn run_on(std::int64_t at_most, std::int64_t if_held) {
  v1::RunOn run_on;
  run_on.set_at_most(at_most);
  run_on.set_if_held(if_held);
  return run_on;
}

std::string progress(std::int64_t written, std::int64_t executed_least, std::int64_t executed_most) {
  return progress_text(frame(7, v1::JOB_STATE_RUNNING), running(written, executed_least, executed_most));
}

TEST(MillProgress, ARangeWithItsTimeLeft) {
  EXPECT_EQ(
      progress(15'000, 12'300, 13'200),
      "SENDING [====-     ] 41 to 44 %, 15000 of 30000 bytes written, 12300 taken, 5 min 36 s to 9 min 50 s left");
}

// The lower bound is rounded down and the upper bound up, so that the range never excludes the truth.
TEST(MillProgress, RoundsOutwards) {
  EXPECT_EQ(progress(15'000, 299, 301).substr(0, 31), "SENDING [-         ] 0 to 2 %, ");
  EXPECT_EQ(progress(30'000, 29'999, 30'000),
            "SENDING [=========-] 99 to 100 %, 30000 of 30000 bytes written, 29999 taken, 0 s left");
}

TEST(MillProgress, OneNumberWhereBothEndsAreTheSame) {
  EXPECT_EQ(progress(0, 0, 0),
            "SENDING [          ] 0 %, 0 of 30000 bytes written, 0 taken, 10 min 0 s to 16 min 40 s left");
  EXPECT_EQ(progress(30'000, 30'000, 30'000),
            "SENDING [==========] 100 %, 30000 of 30000 bytes written, 30000 taken, 0 s left");
}

// A faulty daemon may send numbers beyond the job, or a job without a size. The text must still be one valid line.
TEST(MillProgress, WithinTheJob) {
  EXPECT_EQ(progress(30'000, -5, 40'000),
            "SENDING [----------] 0 to 100 %, 30000 of 30000 bytes written, -5 taken, 0 s to 16 min 40 s left");
  v1::Job empty = frame(7, v1::JOB_STATE_RUNNING);
  empty.set_bytes(0);
  EXPECT_EQ(progress_text(empty, running(0, 0, 0)),
            "SENDING [----------] 0 to 100 %, 0 of 0 bytes written, 0 taken, 10 min 0 s to 16 min 40 s left");
}

TEST(MillProgress, EachState) {
  v1::RunningJob now = running(0, 0, 0);
  const auto begins = [&now](v1::SendingState state) {
    now.set_sending(state);
    const std::string text = progress_text(frame(7, v1::JOB_STATE_RUNNING), now);
    return text.substr(0, text.find(' '));
  };
  EXPECT_EQ(begins(v1::SENDING_STATE_PAUSED), "PAUSED");
  EXPECT_EQ(begins(v1::SENDING_STATE_FINISHING), "FINISHING");
  EXPECT_EQ(begins(v1::SENDING_STATE_ABORTING), "ABORTING");
  EXPECT_EQ(begins(static_cast<v1::SendingState>(99)), "(99)");
}

TEST(MillTexts, AJob) {
  EXPECT_EQ(state_text(frame(7, v1::JOB_STATE_QUEUED)), "job 7 (frame.rml) QUEUED; takes 10 min 0 s to 16 min 40 s");
  v1::Job job = frame(7, v1::JOB_STATE_QUEUED);
  job.set_title("a\x1b[2Jb\n");
  EXPECT_EQ(job_text(job), "job 7 (a [2Jb )");
}

TEST(MillTexts, WhatRunsOn) {
  EXPECT_EQ(run_on_text(run_on(64, 2048)),
            "after an abort at most 64 bytes run on, at most 2048 if the panel holds the mill (VIEW, an open cover)");
  EXPECT_EQ(run_on_text(run_on(1, 1)), "after an abort at most 1 byte run on");
}

// 15,000 bytes are written, 20 of them are still on this host, and at most 14,970 are executed: at least 10 still run.
TEST(MillTexts, APauseSaysWhatStillRuns) {
  v1::RunningJob paused = running(15'000, 14'000, 14'970);
  paused.set_unsent(20);
  *paused.mutable_run_on() = run_on(64, 64);
  EXPECT_EQ(paused_text(paused),
            "job 7 is paused: 10 to 64 bytes of it still run; the cutter keeps turning in the cut");
  paused.set_executed_most(15'000);
  *paused.mutable_run_on() = run_on(64, 2048);
  EXPECT_EQ(paused_text(paused),
            "job 7 is paused: 0 to 64 bytes of it still run, at most 2048 if the panel holds the mill (VIEW, an open "
            "cover); the cutter keeps turning in the cut");
  paused.set_executed_most(0);
  *paused.mutable_run_on() = run_on(64, 64);
  EXPECT_EQ(paused_text(paused), "job 7 is paused: 64 bytes of it still run; the cutter keeps turning in the cut");
}

// The time is rounded up: below 10 s to a tenth of a second, otherwise to a second.
TEST(MillTexts, WhatRunsOnHasATime) {
  const auto text = [](std::int64_t ms) {
    v1::RunOn bound = run_on(64, 64);
    *bound.mutable_longest_time() = TimeUtil::MillisecondsToDuration(ms);
    return run_on_text(bound);
  };
  EXPECT_EQ(text(3200), "after an abort at most 64 bytes, up to 3.2 s, run on");
  EXPECT_EQ(text(3201), "after an abort at most 64 bytes, up to 3.3 s, run on");
  EXPECT_EQ(text(9901), "after an abort at most 64 bytes, up to 10 s, run on");
  EXPECT_EQ(text(10'001), "after an abort at most 64 bytes, up to 11 s, run on");
  EXPECT_EQ(text(60'400), "after an abort at most 64 bytes, up to 1 min 1 s, run on");
  v1::AbortJobResponse response;
  *response.mutable_running() = running(15'000, 12'300, 13'200);
  *response.mutable_running()->mutable_run_on() = run_on(64, 64);
  *response.mutable_running()->mutable_run_on()->mutable_longest_time() = TimeUtil::MillisecondsToDuration(3200);
  EXPECT_EQ(paused_text(response.running()),
            "job 7 is paused: 64 bytes of it, up to 3.2 s, still run; the cutter keeps turning in the cut");
  EXPECT_EQ(
      aborted_text(response),
      "the abort was sent: at most 64 bytes of job 7, up to 3.2 s, may run on; look at the mill; it may move for up "
      "to 3.2 s: in an emergency use its own emergency stop");
}

TEST(MillTexts, AnAbortNeverSaysThatTheMillHasStopped) {
  v1::AbortJobResponse response;
  EXPECT_EQ(aborted_text(response),
            "the abort was sent; no job ran; look at the mill; in an emergency use its own emergency stop");
  *response.mutable_running() = running(15'000, 12'300, 13'200);
  *response.mutable_running()->mutable_run_on() = run_on(64, 64);
  EXPECT_EQ(aborted_text(response),
            "the abort was sent: at most 64 bytes of job 7 may run on; look at the mill; in an emergency use its "
            "own emergency stop");
}

// The text says "by the mill's profile", because the panel may have held the mill.
TEST(MillTexts, WhereWhatWasExecutedEnds) {
  v1::AbortJobResponse response;
  *response.mutable_running() = running(15'000, 12'300, 13'200);
  *response.mutable_running()->mutable_run_on() = run_on(64, 64);
  *response.mutable_executed() = executed_lines(8, 13);
  EXPECT_EQ(aborted_text(response),
            "the abort was sent: at most 64 bytes of job 7 may run on; by the mill's profile what is executed ends "
            "between line "
            "8, column 1 and line 13, column 1; look at the mill; in an emergency use its own emergency stop");
  v1::Job job = frame(7, v1::JOB_STATE_ABORTED);
  *job.mutable_executed() = executed_lines(8, 8);
  EXPECT_EQ(executed_text(job), "by the mill's profile what was executed ends at line 8, column 1");
  job.add_parts();
  job.add_parts();
  job.set_part(2);
  EXPECT_EQ(executed_text(job), "by the mill's profile what was executed of part 2 of 2 ends at line 8, column 1");
  EXPECT_EQ(remains_text(job),
            "`axisctl mill preview FILE --profile mdx-20 --from 8:1 -o rest.svg` draws what remains");
  job.mutable_setup()->set_profile("Our mill");
  EXPECT_THAT(remains_text(job), HasSubstr("--profile PROFILE --from 8:1 "));
  v1::Mill mill;
  *mill.mutable_ended() = job;
  EXPECT_THAT(queue_lines(mill), Contains("job 7 (frame.rml) was aborted: " + executed_text(job)));
  mill.mutable_ended()->set_state(v1::JOB_STATE_DONE);
  EXPECT_THAT(queue_lines(mill), testing::Not(Contains(HasSubstr("aborted"))));
}

TEST(MillTexts, HowAJobIsSentAndWhatRunsOn) {
  v1::Job job = frame(7, v1::JOB_STATE_QUEUED);
  job.set_streaming(v1::STREAMING_FULL);
  *job.mutable_run_on() = run_on(1560, 1560);
  *job.mutable_run_on()->mutable_longest_time() = TimeUtil::MillisecondsToDuration(14'200);
  job.mutable_run_on()->set_mm(120.2);
  EXPECT_EQ(state_text(job),
            "job 7 (frame.rml) QUEUED; takes 10 min 0 s to 16 min 40 s, full; after an abort at most 1560 bytes, up to "
            "15 s and 121 mm, run on");
  EXPECT_THAT(setup_lines(job), Contains("  takes     10 min 0 s to 16 min 40 s, full"));
  EXPECT_THAT(setup_lines(job),
              Contains("  abort     after an abort at most 1560 bytes, up to 15 s and 121 mm, run on"));
}

TEST(MillTexts, WhatIsSetUp) {
  v1::Job job = frame(7, v1::JOB_STATE_QUEUED);
  EXPECT_EQ(setup_lines(job),
            (Lines{"job 7 (frame.rml) of unix anna", "  tool      T1", "  origin    as it is set at the panel",
                   "  profile   MDX-20", "  takes     10 min 0 s to 16 min 40 s", "  digest    3f5a9c001b2d..."}));
  EXPECT_EQ(setup_question(job),
            "The material is in, the tool T1 is in, the origin is set, and nothing is in the way? [yes/no]");
  job.mutable_setup()->set_origin("left vice");
  job.mutable_setup()->clear_tool();
  EXPECT_EQ(setup_question(job),
            "The material is in, the tool is in, the origin left vice is set, and nothing is in the way? [yes/no]");
}

TEST(MillTexts, WhatIsSetUpForALaterPart) {
  v1::Job job = frame(7, v1::JOB_STATE_TOOL_CHANGE);
  for (const char* tool : {"T3", "T1"}) job.add_parts()->set_tool(tool);
  EXPECT_EQ(setup_lines(job)[1], "  part      1 of 2");
  EXPECT_EQ(setup_question(job),
            "The material is in, the tool T1 is in, the origin is set, and nothing is in the way? [yes/no]");
  job.set_part(2);
  EXPECT_EQ(setup_lines(job)[1], "  part      2 of 2");
  EXPECT_EQ(setup_lines(job)[2], "  tool      T1");
  EXPECT_EQ(setup_question(job), "The tool T1 is in, Z0 is set, and nothing is in the way? [yes/no]");
}

TEST(MillTexts, WhatIsSetUpForTheRestOfAJob) {
  v1::Job job = frame(7, v1::JOB_STATE_PAUSED);
  job.mutable_setup()->mutable_start()->set_line(12);
  job.mutable_setup()->mutable_start()->set_column(40);
  EXPECT_EQ(setup_lines(job).back(), "  continues at line 12, column 40");
  EXPECT_EQ(setup_question(job), "The tool T1 is in, Z0 is as it was, and nothing is in the way? [yes/no]");
}

TEST(MillTexts, TheWorkpieceOfAJob) {
  v1::Job job = frame(7, v1::JOB_STATE_QUEUED);
  job.mutable_stock()->mutable_x()->set_mm("80");
  job.mutable_stock()->mutable_y()->set_mm("50");
  job.mutable_stock()->mutable_z()->set_mm("10.5");
  EXPECT_EQ(setup_lines(job)[1], "  material  80 x 50 x 10.5 mm");
}

TEST(MillTexts, WhatTheJobBeforeHasLeft) {
  v1::Job job = frame(7, v1::JOB_STATE_QUEUED);
  job.mutable_setup()->add_left("job 6 (a\x1b[2Jb) sets Z0");
  EXPECT_EQ(setup_lines(job).back(), "  before    job 6 (a [2Jb) sets Z0");
}

TEST(MillQueue, NothingToDo) {
  v1::Mill mill;
  mill.set_name("devices/mill");
  mill.set_profile("MDX-20");
  EXPECT_EQ(queue_lines(mill), (Lines{"mill  MDX-20  line closed", "no job runs", "no jobs"}));
}

TEST(MillQueue, TheMeasuredPaceIsALine) {
  v1::Mill mill;
  mill.set_name("devices/mill");
  mill.mutable_measured_pace()->set_least(1.183);
  mill.mutable_measured_pace()->set_most(1.242);
  EXPECT_EQ(queue_lines(mill)[2], "measured: the mill takes 1.18 to 1.24 times as long as the slowest of its profile");
}

TEST(MillQueue, ATable) {
  ::setenv("TZ", "UTC", 1);
  ::tzset();
  v1::Mill mill;
  mill.set_name("devices/mill");
  mill.set_profile("MDX-20");
  mill.set_line_open(true);
  *mill.add_jobs() = frame(7, v1::JOB_STATE_CONFIRMED);
  mill.mutable_jobs(0)->mutable_confirmed_by()->set_name("unix bert");
  *mill.mutable_jobs(0)->mutable_confirmation_expire_time() = TimeUtil::SecondsToTimestamp(1'795'000'200);
  *mill.mutable_jobs(0)->mutable_extent() = cut_out();
  *mill.add_jobs() = frame(12, v1::JOB_STATE_QUEUED);
  mill.mutable_jobs(1)->mutable_setup()->clear_tool();
  mill.mutable_jobs(1)->mutable_setup()->set_origin("vice");
  EXPECT_EQ(queue_lines(mill),
            (Lines{"mill  MDX-20  line open", "no job runs",
                   "job  title      owner      state      tool  origin  size                          "
                   "takes                      begins at the earliest        confirmed",
                   "7    frame.rml  unix anna  CONFIRMED  T1    panel   38.0 x 30.0 mm, 1.70 mm deep  "
                   "10 min 0 s to 16 min 40 s  now                           by unix bert until "
                   "2026-11-18 11:10:00+00:00",
                   "12   frame.rml  unix anna  QUEUED     -     vice    -                             "
                   "10 min 0 s to 16 min 40 s  in 10 min 0 s to 16 min 40 s  -"}));
}

TEST(MillQueue, APartOfAJob) {
  v1::Mill mill;
  v1::Job& job = (*mill.add_jobs() = frame(7, v1::JOB_STATE_TOOL_CHANGE));
  for (const char* tool : {"T1", "T3", "T1"}) job.add_parts()->set_tool(tool);
  job.set_part(2);
  job.mutable_setup()->set_tool("T3");
  EXPECT_EQ(queue_lines(mill)[3],
            "7    frame.rml  unix anna  TOOL_CHANGE  part 2 of 3, T3  panel   -     10 min 0 s to 16 min 40 s  now     "
            "        "
            "        -");
}

TEST(MillQueue, WhereAJobContinues) {
  v1::Mill mill;
  v1::Job& job = (*mill.add_jobs() = frame(7, v1::JOB_STATE_PAUSED));
  job.mutable_setup()->mutable_start()->set_line(8);
  EXPECT_THAT(queue_lines(mill)[3], HasSubstr("unix anna  PAUSED (line 8)  T1"));
  job.set_state(v1::JOB_STATE_PAUSED_UNKNOWN);
  EXPECT_THAT(queue_lines(mill)[3], HasSubstr("unix anna  PAUSED_UNKNOWN  T1")) << "that was before the line broke";
  job.set_state(v1::JOB_STATE_PAUSED);
  EXPECT_EQ(state_text(job), "job 7 (frame.rml) PAUSED, from line 8 on; takes 10 min 0 s to 16 min 40 s");
  job.set_continues("devices/mill/jobs/3");
  EXPECT_EQ(state_text(job),
            "job 7 (frame.rml) PAUSED, from line 8 on, on the workpiece of job 3; takes 10 min 0 s to 16 min 40 s");
}

// Returns the cell "begins at the earliest" of each job, found by the headings, so that the widths do not matter.
Lines beginnings(const v1::Mill& mill) {
  const Lines lines = queue_lines(mill);
  const std::size_t begin = lines[2].find("begins at the earliest"), end = lines[2].find("confirmed");
  Lines cells;
  for (std::size_t i = 3; i < lines.size(); ++i) {
    const std::string cell = lines[i].substr(begin, end - begin);
    cells.push_back(cell.substr(0, cell.find_last_not_of(' ') + 1));
  }
  return cells;
}

// 12,300 to 13,200 of 30,000 bytes are executed, so 336 to 590 s are left.
TEST(MillQueue, WhatWaitsBeginsWhenAllBeforeItIsDone) {
  v1::Mill mill;
  *mill.add_jobs() = frame(7, v1::JOB_STATE_RUNNING);
  *mill.mutable_running() = running(15'000, 12'300, 13'200);
  for (const int number : {8, 9, 10}) *mill.add_jobs() = frame(number, v1::JOB_STATE_QUEUED);
  EXPECT_EQ(beginnings(mill), (Lines{"-", "in 5 min 36 s to 9 min 50 s", "in 15 min 36 s to 26 min 30 s",
                                     "in 25 min 36 s to 43 min 10 s"}));
}

TEST(MillQueue, OfAJobInAToolChangeWhatIsLeftCounts) {
  v1::Mill mill;
  v1::Job& job = (*mill.add_jobs() = frame(7, v1::JOB_STATE_TOOL_CHANGE));
  *job.mutable_shortest_time() = TimeUtil::SecondsToDuration(400);
  *job.mutable_longest_time() = TimeUtil::SecondsToDuration(667);
  *mill.add_jobs() = frame(8, v1::JOB_STATE_QUEUED);
  EXPECT_EQ(beginnings(mill), (Lines{"now", "in 6 min 40 s to 11 min 7 s"}));
}

TEST(MillQueue, WhatIsOverTakesNoTimeButHoldsUpTheNext) {
  v1::Mill mill;
  *mill.add_jobs() = frame(6, v1::JOB_STATE_PAUSED_UNKNOWN);
  *mill.add_jobs() = frame(7, v1::JOB_STATE_FED);
  *mill.add_jobs() = frame(8, v1::JOB_STATE_QUEUED);
  EXPECT_EQ(beginnings(mill), (Lines{"-", "-", "when job 6 is done"})) << "a person must look at it first";
  mill.mutable_jobs()->DeleteSubrange(0, 1);
  EXPECT_EQ(beginnings(mill), (Lines{"-", "when job 7 is done"}));
  *mill.add_jobs() = frame(9, v1::JOB_STATE_QUEUED);
  EXPECT_EQ(beginnings(mill), (Lines{"-", "when job 7 is done", "in 10 min 0 s to 16 min 40 s"}));
}

TEST(MillQueue, AJobInAStateThatIsNotKnownTakesItsLongestTime) {
  v1::Mill mill;
  *mill.add_jobs() = frame(6, static_cast<v1::JobState>(99));
  *mill.add_jobs() = frame(7, v1::JOB_STATE_FED);
  *mill.add_jobs() = frame(8, v1::JOB_STATE_QUEUED);
  EXPECT_EQ(beginnings(mill), (Lines{"-", "-", "in 0 s to 16 min 40 s"}));
}

TEST(MillQueue, WhatRuns) {
  v1::Mill mill;
  *mill.add_jobs() = frame(7, v1::JOB_STATE_RUNNING);
  *mill.mutable_running() = running(15'000, 12'300, 13'200);
  EXPECT_EQ(
      queue_lines(mill)[1],
      "job 7 (frame.rml) SENDING [====-     ] 41 to 44 %, 15000 of 30000 bytes written, 12300 taken, 5 min 36 s to "
      "9 min 50 s left");
  mill.mutable_running()->set_busy(true);
  EXPECT_TRUE(queue_lines(mill)[1].ends_with(" left; the mill is busy: look at it"));
}

}  // namespace
}  // namespace axisgate::axisctl
