// Tests of the texts about the size of a job, and about the warnings that its sender has accepted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/axisctl/mill/mill_text.h"
#include "tests/axisctl/cut_out.h"

namespace axisgate::axisctl {
namespace {

TEST(MillExtent, OfAJob) {
  v1::Job job;
  job.set_name("devices/mill/jobs/7");
  job.set_title("frame.rml");
  job.set_state(v1::JOB_STATE_QUEUED);
  *job.mutable_extent() = cut_out();
  job.add_accepted_warnings("deep-pass");
  EXPECT_EQ(state_text(job), "job 7 (frame.rml) QUEUED; takes a time that is not known; 38.0 x 30.0 mm, 1.70 mm deep");
  EXPECT_THAT(setup_lines(job), testing::IsSupersetOf({"  size      38.0 x 30.0 mm, 1.70 mm deep",
                                                       "  reaches   X -1.0 to 38.0, Y 0.0 to 30.0, Z -1.70 to 2.00 mm",
                                                       "  accepted  deep-pass"}));
  job.mutable_extent()->clear_cut_x();
  EXPECT_THAT(state_text(job), testing::EndsWith("QUEUED; takes a time that is not known; cuts nothing"));
}

}  // namespace
}  // namespace axisgate::axisctl
