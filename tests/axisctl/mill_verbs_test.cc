// Tests of the `axisctl mill` verbs that call the daemon: their requests, output and exit codes.
#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "clients/axisctl/failure.h"
#include "tests/axisctl/scripted_mill.h"

namespace axisgate::axisctl {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr std::size_t kPieceSent = 16'384;

class MillSend : public MillVerbs {
 protected:
  MillSend() {
    options_.job.files = {folder_ / "frame.rml"};
    write_job("^IN;PU0,0;");
    add_job(v1::JOB_STATE_QUEUED);
  }

  void write_job(const std::string& content) const {
    std::ofstream(options_.job.files[0], std::ios::binary) << content;
  }
};

TEST_F(MillSend, TheFirstMessageHasEverythingButData) {
  options_.job.accepted = {"deep-pass", "outside-stock"};
  options_.job.streaming = "full";
  options_.job.stock = "80,50,10.5";
  options_.job.made_for = "mdx-20";
  EXPECT_EQ(run("mill send").output,
            "job 7 (frame.rml) QUEUED; takes 10 min 0 s to 16 min 40 s, paced; after an abort at most 64 bytes, up to "
            "3.2 s and 14 mm, run on\n");
  ASSERT_EQ(mill_.sent.size(), 2U);
  const v1::JobHeader& first = mill_.sent[0].header();
  EXPECT_EQ(first.device(), "devices/mill");
  EXPECT_EQ(first.title(), "frame.rml");
  EXPECT_EQ(first.tool(), "T1");  // the first tool of the mill
  EXPECT_EQ(first.origin(), "");
  EXPECT_THAT(first.accepted_warnings(), ElementsAre("deep-pass", "outside-stock"));
  EXPECT_EQ(first.streaming(), v1::STREAMING_FULL);
  EXPECT_EQ(first.stock().x().mm(), "80");
  EXPECT_EQ(first.stock().y().mm(), "50");
  EXPECT_EQ(first.stock().z().mm(), "10.5");
  EXPECT_EQ(first.made_for(), "mdx-20");
  EXPECT_THAT(first.context().request_id(), HasSubstr("axisctl-"));
  EXPECT_EQ(first.context().request_memory(), "since noon");
  EXPECT_EQ(mill_.sent[1].data(), "^IN;PU0,0;");
}

TEST_F(MillSend, AWorkpieceHasThreeLengthsAboveZero) {
  for (const char* stock : {"", "80", "80,50", "80,50,0", "80,-50,10", "80,50,10,1", "a,b,c", "80,50,nan"}) {
    options_.job.stock = stock;
    EXPECT_EQ(run("mill send").exit_code, kUsage) << stock;
  }
  EXPECT_THAT(mill_.sent, IsEmpty());
}

TEST_F(MillSend, WhatWasNamedIsSent) {
  options_.job.title = "lid";
  options_.job.tools = {"T2"};
  options_.job.origin = "vice";
  EXPECT_EQ(run("mill send").exit_code, kDone);
  EXPECT_EQ(mill_.sent[0].header().title(), "lid");
  EXPECT_EQ(mill_.sent[0].header().tool(), "T2");
  EXPECT_EQ(mill_.sent[0].header().origin(), "vice");
}

// axisctl itself refuses names that are not valid titles: the daemon's message would not name the option --title.
TEST_F(MillSend, AFileWhoseNameIsNoTitleNeedsOne) {
  for (const std::string& name : {std::string("lat\xB2in.rml"), std::string(101, 'x'), std::string(".rml")}) {
    options_.job.files = {folder_ / name};
    options_.job.title = "";
    write_job("^IN;");
    const Ended ended = run("mill send");
    EXPECT_EQ(ended.exit_code, kUsage) << name;
    EXPECT_THAT(ended.hint, HasSubstr("--title"));
    EXPECT_THAT(mill_.sent, IsEmpty());
    options_.job.title = "lid";
    EXPECT_EQ(run("mill send").exit_code, kDone) << name;
    EXPECT_EQ(mill_.sent[0].header().title(), "lid");
    mill_.sent.clear();
  }
}

TEST_F(MillSend, SeveralFilesAreThePartsOfOneJob) {
  options_.job.files.push_back(folder_ / "holes.rml");
  std::ofstream(options_.job.files[1], std::ios::binary) << "^IN;";
  options_.job.tools = {"T1", "T3"};
  EXPECT_EQ(run("mill send").exit_code, kDone);
  ASSERT_EQ(mill_.sent.size(), 3U);
  const v1::JobHeader& first = mill_.sent[0].header();
  EXPECT_EQ(first.title(), "frame.rml and 1 more");
  EXPECT_EQ(first.tool(), "");
  ASSERT_EQ(first.parts_size(), 2);
  EXPECT_EQ(first.parts(0).tool(), "T1");
  EXPECT_EQ(first.parts(0).bytes(), 10);
  EXPECT_EQ(first.parts(1).tool(), "T3");
  EXPECT_EQ(first.parts(1).bytes(), 4);
  EXPECT_EQ(mill_.sent[1].data() + mill_.sent[2].data(), "^IN;PU0,0;^IN;");
}

TEST_F(MillSend, EachFileNeedsATool) {
  options_.job.files.push_back(options_.job.files[0]);
  for (const std::vector<std::string>& tools : {std::vector<std::string>{}, {"T1"}, {"T1", "T2", "T3"}}) {
    options_.job.tools = tools;
    const Ended ended = run("mill send");
    EXPECT_EQ(ended.exit_code, kUsage);
    EXPECT_THAT(ended.message, HasSubstr("names for a job of 2 files"));
  }
  EXPECT_THAT(mill_.calls, IsEmpty());
}

TEST_F(MillSend, AMillWithoutTools) {
  mill_.mill.clear_tools();
  EXPECT_EQ(run("mill send").exit_code, kDone);
  EXPECT_EQ(mill_.sent[0].header().tool(), "");
}

TEST_F(MillSend, InPieces) {
  std::string job(2 * kPieceSent + 5, ';');
  job.back() = '\0';  // a job may contain any bytes
  write_job(job);
  EXPECT_EQ(run("mill send").exit_code, kDone);
  std::string received;
  for (const v1::SendJobRequest& message : mill_.sent) {
    EXPECT_LE(message.data().size(), kPieceSent);
    received += message.data();
  }
  EXPECT_EQ(mill_.sent.size(), 4U);
  EXPECT_TRUE(received == job);
}

TEST_F(MillSend, ALostAnswerIsRequestedAgainWithTheSameId) {
  mill_.statuses = {{grpc::StatusCode::UNAVAILABLE, "Socket closed"}, grpc::Status::OK};
  options_.request_id = "lid-1";
  EXPECT_EQ(run("mill send").exit_code, kDone);
  EXPECT_THAT(mill_.calls, ElementsAre("ListDevices", "GetMill", "SendJob", "SendJob"));
  EXPECT_EQ(mill_.sent.size(), 2U);
  EXPECT_EQ(mill_.sent[0].header().context().request_id(), "lid-1");
}

TEST_F(MillSend, ARefusal) {
  mill_.statuses = {{grpc::StatusCode::RESOURCE_EXHAUSTED, "the spool is full"}};
  const Ended ended = run("mill send");
  EXPECT_EQ(ended.exit_code, kRefused);
  EXPECT_EQ(ended.message, "the spool is full");
}

TEST_F(MillSend, AFileThatCannotBeReadIsNotSent) {
  options_.job.files = {folder_ / "missing.rml"};
  const Ended ended = run("mill send");
  EXPECT_EQ(ended.exit_code, kUsage);
  EXPECT_THAT(ended.message, HasSubstr("missing.rml cannot be read: No such file"));
  EXPECT_THAT(mill_.sent, IsEmpty());
  options_.job.files = {folder_};
  EXPECT_THAT(run("mill send").message, HasSubstr("is no regular file"));
}

using MillCalls = MillVerbs;

TEST_F(MillCalls, StartSaysWhatRunsOn) {
  add_job(v1::JOB_STATE_CONFIRMED);
  EXPECT_THAT(run("mill start").output,
              HasSubstr("; after an abort at most 64 bytes, up to 3.2 s and 14 mm, run on\n"));
  EXPECT_EQ(mill_.started[0].job(), "devices/mill/jobs/7");
  options_.job.number = 12;
  run("mill start");
  EXPECT_EQ(mill_.started[1].job(), "devices/mill/jobs/12");
}

TEST_F(MillCalls, PauseResumeCancelDone) {
  add_job(v1::JOB_STATE_RUNNING);
  mill_.mill.mutable_running()->set_job("devices/mill/jobs/7");
  EXPECT_THAT(run("mill pause").output, HasSubstr("job 7 is paused: "));
  EXPECT_THAT(run("mill resume").output, HasSubstr("job 7 is resumed; "));
  EXPECT_THAT(mill_.devices, ElementsAre("devices/mill", "devices/mill"));
  options_.job.number = 7;
  EXPECT_EQ(run("mill cancel").output, "job 7 is CANCELLED\n");
  EXPECT_EQ(run("mill done").output, "job 7 is DONE\n");
  EXPECT_THAT(mill_.jobs, ElementsAre("devices/mill/jobs/7", "devices/mill/jobs/7"));
}

TEST_F(MillCalls, ClearNamesTheJobsThatAreCancelled) {
  add_job(v1::JOB_STATE_QUEUED);
  options_.who = "unix anna";
  EXPECT_EQ(run("mill clear").output, "job 7 of unix anna is CANCELLED\n");
  mill_.mill.add_jobs()->set_name("devices/mill/jobs/9");
  EXPECT_EQ(run("mill clear").output, "jobs 7, 9 of unix anna are CANCELLED\n");
  EXPECT_THAT(mill_.cleared, ElementsAre("unix anna", "unix anna"));
  EXPECT_THAT(mill_.devices, ElementsAre("devices/mill", "devices/mill"));
}

TEST_F(MillCalls, PauseRaisesWhereThatIsRequested) {
  add_job(v1::JOB_STATE_RUNNING);
  mill_.mill.mutable_running()->set_sending(v1::SENDING_STATE_RAISING);
  options_.job.raise = true;
  EXPECT_THAT(run("mill pause").output, HasSubstr("; then the tool is raised and the spindle stops\n"));
  EXPECT_TRUE(mill_.paused.at(0).raise_tool());
}

TEST_F(MillCalls, ResumeOfAJobChoosesWhereItGoesOn) {
  v1::Job& job = add_job(v1::JOB_STATE_PAUSED);
  job.mutable_setup()->mutable_start()->set_line(12);
  job.mutable_setup()->mutable_start()->set_column(40);
  options_.job.number = 7;
  for (const char* from : {"12", "12:40"}) {
    options_.job.from = from;
    EXPECT_THAT(
        run("mill resume").output,
        HasSubstr(
            "is PAUSED: it continues at line 12, column 40; see that tool and Z0 are as before, then `axisctl mill "
            "confirm 7 --start`\n"));
  }
  ASSERT_EQ(mill_.continued.size(), 2U);
  EXPECT_EQ(mill_.continued[0].job(), "devices/mill/jobs/7");
  EXPECT_EQ(mill_.continued[0].line(), 12);
  EXPECT_EQ(mill_.continued[0].column(), 1);
  EXPECT_EQ(mill_.continued[1].column(), 40);
  options_.job.from.reset();
  run("mill resume");
  EXPECT_EQ(mill_.continued.back().line(), 0) << "the daemon's answer says which";
}

TEST_F(MillCalls, WhatIsNoLineIsAUsageError) {
  options_.job.number = 7;
  for (const char* from : {"", "0", "-1", "x", "12:", "12:0", "12:x", ":4", "12 ", "8:1-13:1"}) {
    options_.job.from = from;
    EXPECT_EQ(run("mill resume").exit_code, kUsage) << from;
  }
  EXPECT_THAT(mill_.continued, IsEmpty());
}

TEST_F(MillCalls, First) {
  add_job(v1::JOB_STATE_QUEUED);
  options_.job.number = 7;
  options_.request_id = "front-1";
  EXPECT_EQ(run("mill first").output,
            "job 7 (frame.rml) is as far forward as you may move it; `axisctl mill queue` shows the order\n");
  EXPECT_THAT(mill_.jobs, ElementsAre("devices/mill/jobs/7"));
  mill_.statuses = {{grpc::StatusCode::PERMISSION_DENIED, "job 7 is not yours"}};
  EXPECT_EQ(run("mill first").exit_code, kRefused);
  mill_.statuses = {{grpc::StatusCode::UNAVAILABLE, "Socket closed"}, grpc::Status::OK};
  mill_.calls.clear();
  EXPECT_EQ(run("mill first").exit_code, kDone);
  EXPECT_THAT(mill_.calls, ElementsAre("ListDevices", "MoveJob", "MoveJob"));
}

TEST_F(MillCalls, ALostAnswerIsRequestedAgain) {
  mill_.statuses = {{grpc::StatusCode::UNAVAILABLE, "Socket closed"}, grpc::Status::OK};
  options_.job.number = 7;
  EXPECT_EQ(run("mill cancel").exit_code, kDone);
  EXPECT_THAT(mill_.calls, ElementsAre("ListDevices", "CancelJob", "CancelJob"));
}

TEST_F(MillCalls, NothingIsAskedBeforeAnAbort) {
  EXPECT_EQ(run("mill abort").output,
            "the abort was sent; no job ran; look at the mill; in an emergency use its own emergency stop\n");
  EXPECT_THAT(mill_.calls, ElementsAre("AbortJob"));
}

TEST_F(MillCalls, TheOnlyMillNeedsNoName) {
  options_.device = "";
  for (const auto verb : {"mill queue", "mill pause", "mill resume", "mill abort"})
    EXPECT_EQ(run(verb).exit_code, kDone);
  EXPECT_THAT(mill_.devices, ElementsAre("devices/mill", "devices/mill", "devices/mill", "devices/mill"));
}

TEST_F(MillCalls, OneOfSeveralMillsMustBeNamed) {
  options_.device = "";
  options_.job.files = {"-"};
  add_device("large", "rml1");
  for (const auto verb :
       {"mill send", "mill queue", "mill start", "mill watch", "mill pause", "mill resume", "mill abort"}) {
    const Ended ended = run(verb);
    EXPECT_EQ(ended.exit_code, kUsage);
    EXPECT_EQ(ended.message, "the daemon has 2 mills");
  }
  EXPECT_THAT(mill_.calls, Each("ListDevices"));
}

TEST_F(MillCalls, AJobThatIsPausedIsPausedEverywhere) {
  add_job(v1::JOB_STATE_RUNNING);
  mill_.mill.mutable_running()->set_job("devices/mill/jobs/7");
  mill_.mill.mutable_running()->set_sending(v1::SENDING_STATE_PAUSED);
  const std::string output = run("mill queue").output;
  EXPECT_THAT(output, HasSubstr("job 7 (frame.rml) PAUSED ["));
  EXPECT_THAT(output, HasSubstr("unix anna  PAUSED  "));
  EXPECT_THAT(output, Not(HasSubstr("RUNNING")));
}

TEST_F(MillCalls, QueueAsJson) {
  options_.json = true;
  EXPECT_THAT(run("mill queue").output, HasSubstr(R"("name":"devices/mill")"));
}

}  // namespace
}  // namespace axisgate::axisctl
