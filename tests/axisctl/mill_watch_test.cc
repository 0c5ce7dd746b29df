// Tests of following a job, and of the exit code at the job's end.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "clients/axisctl/failure.h"
#include "tests/axisctl/executed_lines.h"
#include "tests/axisctl/scripted_mill.h"

namespace axisgate::axisctl {
namespace {

using ::testing::HasSubstr;

class MillWatch : public MillVerbs {
 protected:
  MillWatch() { add_job(v1::JOB_STATE_RUNNING); }

  // Adds the state of the mill that the daemon reports next.
  v1::Mill& report(v1::SendingState sending, std::int64_t executed) {
    v1::Mill& state = mill_.watched.emplace_back(mill_.mill);
    v1::RunningJob& running = *state.mutable_running();
    running.set_job("devices/mill/jobs/7");
    running.set_sending(sending);
    running.set_written(15'000);
    running.set_taken(executed);
    running.set_executed_least(executed);
    running.set_executed_most(executed);
    running.mutable_shortest_remaining_time()->set_seconds(600 - executed / 50);
    running.mutable_longest_remaining_time()->set_seconds(1000 - executed / 30);
    running.mutable_run_on()->set_at_most(64);
    running.mutable_run_on()->mutable_longest_time()->set_seconds(3);
    running.mutable_run_on()->mutable_longest_time()->set_nanos(200'000'000);
    return state;
  }

  void report_end(v1::JobState state) { mill_.watched.emplace_back(mill_.mill).mutable_jobs(0)->set_state(state); }
};

TEST_F(MillWatch, EachChangeOnALineUntilItIsFed) {
  report(v1::SENDING_STATE_SENDING, 0);
  report(v1::SENDING_STATE_SENDING, 0);
  report(v1::SENDING_STATE_SENDING, 15'000);
  report_end(v1::JOB_STATE_FED);
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kDone);
  EXPECT_EQ(
      ended.output,
      "job 7 (frame.rml) RUNNING; takes 10 min 0 s to 16 min 40 s, paced; after an abort at most 64 bytes, up to 3.2 s "
      "and 14 mm, run on\n"
      "SENDING [          ] 0 %, 15000 of 30000 bytes written, 0 taken, 10 min 0 s to 16 min 40 s left\n"
      "SENDING [=====     ] 50 %, 15000 of 30000 bytes written, 15000 taken, 5 min 0 s to 8 min 20 s left\n"
      "job 7 (frame.rml) FED: all was sent, and the slowest mill has executed it by now; look at the workpiece, "
      "then `axisctl mill done 7`\n");
}

TEST_F(MillWatch, AsJson) {
  report(v1::SENDING_STATE_SENDING, 14'488);
  report_end(v1::JOB_STATE_FED);
  options_.json = true;
  const std::string output = run("mill watch").output;
  EXPECT_THAT(output, HasSubstr("\"taken\":\"14488\""));
  EXPECT_THAT(output, HasSubstr("\"longest_time\":\"3.200s\""));
}

TEST_F(MillWatch, UntilAToolIsToBeChanged) {
  report(v1::SENDING_STATE_SENDING, 0);
  report_end(v1::JOB_STATE_TOOL_CHANGE);
  v1::Job& job = *mill_.watched.back().mutable_jobs(0);
  for (const char* tool : {"T1", "T3", "T1"}) job.add_parts()->set_tool(tool);
  job.set_part(2);
  job.mutable_setup()->set_tool("T3");
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kDone);
  EXPECT_THAT(ended.output, HasSubstr("\njob 7 (frame.rml) TOOL_CHANGE: part 1 of 3 was sent, and the slowest mill has "
                                      "executed it by now; put in the tool T3, set Z0, then `axisctl mill confirm 7 "
                                      "--start`\n"));
}

TEST_F(MillWatch, BusyIsSaidOnceEachTime) {
  report(v1::SENDING_STATE_SENDING, 0);
  report(v1::SENDING_STATE_SENDING, 1).mutable_running()->set_busy(true);
  report(v1::SENDING_STATE_SENDING, 2).mutable_running()->set_busy(true);
  report(v1::SENDING_STATE_SENDING, 3);
  report(v1::SENDING_STATE_SENDING, 4).mutable_running()->set_busy(true);
  report_end(v1::JOB_STATE_FED);
  const std::string output = run("mill watch").output;
  const std::string busy = "the mill is busy: look at it\n";
  const std::size_t first = output.find(busy), second = output.find(busy, first + 1);
  EXPECT_NE(second, std::string::npos);
  EXPECT_EQ(output.find(busy, second + 1), std::string::npos);
}

TEST_F(MillWatch, AnAbortedJobHasLeftTheQueue) {
  report(v1::SENDING_STATE_ABORTING, 0);
  mill_.watched.emplace_back(mill_.mill).clear_jobs();
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_EQ(ended.reason, "ABORTED");
}

TEST_F(MillWatch, AbortedIsNoSuccess) {
  report(v1::SENDING_STATE_SENDING, 0);
  report_end(v1::JOB_STATE_ABORTED);
  EXPECT_EQ(run("mill watch").reason, "ABORTED");
}

// A newer daemon may send an unknown state.
TEST_F(MillWatch, AnUnknownStateIsNoSuccess) {
  report(v1::SENDING_STATE_SENDING, 0);
  report_end(static_cast<v1::JobState>(99));
  EXPECT_EQ(run("mill watch").exit_code, kFailed);
}

TEST_F(MillWatch, AJobThatIsGoneIsNotSaidToBeAborted) {
  report(v1::SENDING_STATE_SENDING, 0);
  mill_.watched.emplace_back(mill_.mill).clear_jobs();
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_EQ(ended.reason, "OUTCOME_UNKNOWN");
}

// The job may leave the queue before its short last state was reported.
TEST_F(MillWatch, HowAJobThatIsGoneHasEndedIsReported) {
  report(v1::SENDING_STATE_SENDING, 0);
  v1::Mill& gone = mill_.watched.emplace_back(mill_.mill);
  *gone.mutable_ended() = gone.jobs(0);
  gone.mutable_ended()->set_state(v1::JOB_STATE_ABORTED);
  gone.clear_jobs();
  EXPECT_EQ(run("mill watch").reason, "ABORTED");
  *gone.mutable_ended()->mutable_executed() = executed_lines(8, 13);
  EXPECT_EQ(run("mill watch").message,
            "the abort of job 7 (frame.rml) was sent; whether the mill has followed it is not known; by the mill's "
            "profile what was executed ends between line 8, column 1 and line 13, column 1");
  gone.mutable_ended()->set_state(v1::JOB_STATE_DONE);
  const Ended done = run("mill watch");
  EXPECT_EQ(done.exit_code, kDone);
  EXPECT_THAT(done.output, HasSubstr("job 7 (frame.rml) DONE: somebody has seen its workpiece\n"));
  gone.mutable_ended()->set_name("devices/mill/jobs/6");
  EXPECT_EQ(run("mill watch").reason, "OUTCOME_UNKNOWN");
}

TEST_F(MillWatch, AfterALostLine) {
  report(v1::SENDING_STATE_SENDING, 0);
  report_end(v1::JOB_STATE_PAUSED_UNKNOWN);
  mill_.watched.back().mutable_jobs(0)->set_sent_least(1000);
  mill_.watched.back().mutable_jobs(0)->set_sent_most(1200);
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_EQ(ended.message,
            "job 7 (frame.rml): the line broke, or the daemon was killed; the mill was sent 1000 to 1200 of 30000 "
            "bytes");
}

TEST_F(MillWatch, ADaemonThatEnds) {
  report(v1::SENDING_STATE_SENDING, 0);
  mill_.watch_ends = true;
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_EQ(ended.message, "the daemon reports no more of job 7: the daemon ends");
  mill_.watched.clear();
  EXPECT_EQ(run("mill watch").exit_code, kUnavailable);  // no job was seen running
}

TEST_F(MillWatch, TheNextJobWhereNoneRuns) {
  mill_.watched.resize(2, mill_.mill);
  mill_.watched[0].mutable_jobs(0)->set_state(v1::JOB_STATE_CONFIRMED);
  mill_.watched[1].mutable_jobs(0)->set_state(v1::JOB_STATE_CONFIRMED);
  report(v1::SENDING_STATE_SENDING, 0);
  report_end(v1::JOB_STATE_FED);
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kDone);
  EXPECT_EQ(
      ended.output.find("no job runs; job 7 (frame.rml) is confirmed, and waits to be started: `axisctl mill start "
                        "7`\njob 7 (frame.rml) RUNNING; "),
      0U);
}

TEST_F(MillWatch, EndsWhereNothingRunsOrWaits) {
  mill_.watched.resize(1, mill_.mill);
  mill_.watched[0].clear_jobs();
  const Ended ended = run("mill watch");
  EXPECT_EQ(ended.exit_code, kDone);
  EXPECT_EQ(ended.output, "no job runs, and none waits\n");
}

TEST_F(MillWatch, OneObjectAMessage) {
  options_.json = true;
  report(v1::SENDING_STATE_SENDING, 0);
  report_end(v1::JOB_STATE_FED);
  const std::string output = run("mill watch").output;
  EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 2);
  EXPECT_THAT(output, HasSubstr("\"running\":{\"job\":\"devices/mill/jobs/7\""));
}

// The first reported state may be older than the start.
TEST_F(MillWatch, AJobThatWasJustStarted) {
  mill_.watched.push_back(mill_.mill);
  mill_.watched[0].mutable_jobs(0)->set_state(v1::JOB_STATE_CONFIRMED);
  report(v1::SENDING_STATE_SENDING, 0);
  report_end(v1::JOB_STATE_FED);
  mill_.mill.mutable_jobs(0)->set_state(v1::JOB_STATE_CONFIRMED);
  options_.follow = true;
  const Ended ended = run("mill start");
  EXPECT_EQ(ended.exit_code, kDone);
  EXPECT_EQ(ended.output.find("job 7 (frame.rml) CONFIRMED; takes 10 min 0 s to 16 min 40 s, paced; after an abort at "
                              "most 64 bytes, up to 3.2 s and 14 mm, run on\nSENDING "),
            0U);
  EXPECT_THAT(ended.output, HasSubstr("job 7 (frame.rml) FED: "));
}

}  // namespace
}  // namespace axisgate::axisctl
