// Tests of `axisctl mill confirm`: its question, its requests, and the start of the job.
#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <unistd.h>

#include <cstdio>
#include <string>

#include "clients/axisctl/failure.h"
#include "tests/axisctl/scripted_mill.h"
#include "tests/axisctl/terminal.h"

namespace axisgate::axisctl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MillConfirm : public MillVerbs {};

TEST_F(MillConfirm, WhatWasShownIsConfirmed) {
  add_job(v1::JOB_STATE_FED);
  v1::Job& job = add_job(v1::JOB_STATE_QUEUED);
  options_.yes = true;
  EXPECT_THAT(run("mill confirm").output, HasSubstr("job 8 (frame.rml) of unix anna\n  tool      T1\n"));
  ASSERT_EQ(mill_.confirmed.size(), 1U);
  EXPECT_EQ(mill_.confirmed[0].job(), "devices/mill/jobs/8");  // job 7 does not wait
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(mill_.confirmed[0].seen(), job.setup()));
}

TEST_F(MillConfirm, NeedsATerminalOrYes) {
  add_job(v1::JOB_STATE_QUEUED);
  const int input = ::dup(STDIN_FILENO);
  ASSERT_NE(std::freopen("/dev/null", "r", stdin), nullptr);
  EXPECT_EQ(run("mill confirm").exit_code, kUsage);
  ::dup2(input, STDIN_FILENO);
  ::close(input);
  EXPECT_THAT(mill_.calls, IsEmpty());
}

TEST_F(MillConfirm, OnlyYesCounts) {
  add_job(v1::JOB_STATE_QUEUED);
  for (const char* answer : {"\n", "ye\n", "yes please\n", "no\n"}) {
    Terminal terminal(STDIN_FILENO);
    terminal.type(answer);
    const Ended ended = run("mill confirm");
    EXPECT_EQ(ended.exit_code, kFailed) << answer;
    EXPECT_EQ(ended.reason, "NOT_CONFIRMED");
    EXPECT_THAT(ended.output, HasSubstr("\nThe material is in, the tool T1 is in, the origin is set, and nothing is in "
                                        "the way? [yes/no]\n"));
  }
  EXPECT_THAT(mill_.confirmed, IsEmpty());
  for (const char* answer : {"yes\n", "y\n", " Yes \n", "Y\n"}) {
    Terminal terminal(STDIN_FILENO);
    terminal.type(answer);
    EXPECT_EQ(run("mill confirm").exit_code, kDone) << answer;
  }
  EXPECT_EQ(mill_.confirmed.size(), 4U);
}

TEST_F(MillConfirm, ALaterPartIsTheNextToConfirm) {
  v1::Job& job = add_job(v1::JOB_STATE_TOOL_CHANGE);
  for (const char* tool : {"T1", "T2"}) job.add_parts()->set_tool(tool);
  job.set_part(2);
  job.mutable_setup()->set_tool("T2");
  Terminal terminal(STDIN_FILENO);
  terminal.type("yes\n");
  EXPECT_THAT(run("mill confirm").output,
              HasSubstr("\nThe tool T2 is in, Z0 is set, and nothing is in the way? [yes/no]\n"));
  EXPECT_EQ(mill_.confirmed[0].seen().tool(), "T2");
}

TEST_F(MillConfirm, WhatTheJobBeforeHasLeftIsSeen) {
  add_job(v1::JOB_STATE_QUEUED).mutable_setup()->add_left("job 6 (lid.rml) sets Z0");
  options_.yes = true;
  EXPECT_THAT(run("mill confirm").output, HasSubstr("\n  before    job 6 (lid.rml) sets Z0\n"));
  EXPECT_THAT(mill_.confirmed[0].seen().left(), ElementsAre("job 6 (lid.rml) sets Z0"));
}

TEST_F(MillConfirm, JsonAsksNobody) {
  add_job(v1::JOB_STATE_QUEUED);
  options_.json = true;
  Terminal terminal(STDIN_FILENO);
  terminal.type("yes\n");
  EXPECT_EQ(run("mill confirm").exit_code, kUsage);
  options_.yes = true;
  EXPECT_EQ(run("mill confirm").output.front(), '{');
}

TEST_F(MillConfirm, AndStart) {
  add_job(v1::JOB_STATE_QUEUED);
  options_.yes = options_.job.start = true;
  options_.request_id = "lid-1";
  EXPECT_EQ(run("mill confirm").exit_code, kDone);
  ASSERT_EQ(mill_.started.size(), 1U);
  EXPECT_EQ(mill_.confirmed[0].context().request_id(), "lid-1");
  EXPECT_EQ(mill_.started[0].context().request_id(), "lid-1-start");
}

TEST_F(MillConfirm, WhatDoesNotStartIsConfirmedNevertheless) {
  add_job(v1::JOB_STATE_QUEUED);
  options_.yes = options_.job.start = true;
  mill_.statuses = {grpc::Status::OK, {grpc::StatusCode::FAILED_PRECONDITION, "the mill may still move"}};
  const Ended ended = run("mill confirm");
  EXPECT_NE(ended.exit_code, kDone);
  EXPECT_THAT(ended.hint, HasSubstr("the job is confirmed: `axisctl mill start 7`"));
}

TEST_F(MillConfirm, NothingStartsThatIsNotConfirmed) {
  add_job(v1::JOB_STATE_QUEUED);
  options_.yes = options_.job.start = true;
  mill_.statuses = {{grpc::StatusCode::PERMISSION_DENIED, "not at the station"}};
  EXPECT_EQ(run("mill confirm").exit_code, kRefused);
  EXPECT_THAT(mill_.started, IsEmpty());
}

TEST_F(MillConfirm, AJobThatIsNotThere) {
  options_.yes = true;
  EXPECT_EQ(run("mill confirm").message, "no job waits at mill");
  options_.job.number = 12;
  EXPECT_EQ(run("mill confirm").message, "mill has no job 12");
  EXPECT_THAT(mill_.confirmed, IsEmpty());
}

}  // namespace
}  // namespace axisgate::axisctl
