// Tests of the requests that queue an ended job once more, whole or from a line on.
#include <gmock/gmock.h>

#include "clients/axisctl/failure.h"
#include "tests/axisctl/scripted_mill.h"

namespace axisgate::axisctl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MillRepeat : public MillVerbs {
 protected:
  MillRepeat() { add_job(v1::JOB_STATE_QUEUED); }
};

TEST_F(MillRepeat, AJobAgain) {
  options_.job.number = 3;
  options_.job.accepted = {"deep-pass"};
  EXPECT_THAT(run("mill again").output, HasSubstr("job 7 (frame.rml) QUEUED; takes "));
  ASSERT_EQ(mill_.repeated.size(), 1U);
  EXPECT_EQ(mill_.repeated[0].job(), "devices/mill/jobs/3");
  EXPECT_FALSE(mill_.repeated[0].rest());
  EXPECT_THAT(mill_.repeated[0].accepted_warnings(), ElementsAre("deep-pass"));
  EXPECT_THAT(mill_.repeated[0].context().request_id(), HasSubstr("axisctl-"));
}

TEST_F(MillRepeat, TheRestOfAJob) {
  options_.job.rest_of = 3;
  options_.job.from = "12:40";
  EXPECT_EQ(run("mill send").exit_code, kDone);
  ASSERT_EQ(mill_.repeated.size(), 1U);
  EXPECT_TRUE(mill_.repeated[0].rest());
  EXPECT_EQ(mill_.repeated[0].line(), 12);
  EXPECT_EQ(mill_.repeated[0].column(), 40);
  options_.job.from.reset();
  EXPECT_EQ(run("mill send").exit_code, kDone) << "the daemon's answer says where what was executed ends";
  EXPECT_EQ(mill_.repeated[1].line(), 0);
  EXPECT_THAT(mill_.sent, IsEmpty());
}

TEST_F(MillRepeat, TheRestOfAJobHasAllElseOfThatJob) {
  options_.job.rest_of = 3;
  options_.job.tools = {"T1"};
  EXPECT_EQ(run("mill send").exit_code, kUsage);
  EXPECT_THAT(mill_.calls, IsEmpty());
}

TEST_F(MillRepeat, WithoutAFileAndWithoutAJobNothingIsSent) {
  const Ended ended = run("mill send");
  EXPECT_EQ(ended.exit_code, kUsage);
  EXPECT_EQ(ended.message, "FILE is required");
}

TEST_F(MillRepeat, DoneIsTheJobThatIsFed) {
  EXPECT_EQ(run("mill done").exit_code, kRefused) << "none is";
  mill_.mill.mutable_jobs(0)->set_state(v1::JOB_STATE_FED);
  EXPECT_EQ(run("mill done").output, "job 7 is DONE\n");
}

}  // namespace
}  // namespace axisgate::axisctl
