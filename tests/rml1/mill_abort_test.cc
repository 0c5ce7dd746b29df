// Tests of an abort that a full buffer may have dropped. It ends no job: a person must state the outcome.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/mill_controller_fixture.h"

namespace axisgate::rml1::mill_abort_test {
namespace {

using namespace std::chrono_literals;
using testing::StartsWith;
using enum jobs::JobState;

using MillAbortTest = MillControllerTest;

// The panel may have stopped the mill all the time: the buffer is then full of the bytes written.
TEST_F(MillAbortTest, WithoutFlowControlAnAbortMayBeDropped) {
  settings_.sending.buffer = 64;
  add(1);
  run_job(1, 20);
  run_for(8s);
  ASSERT_TRUE(mill_.abort({.who = "unix carl"}, now_));
  run_for(1s);
  EXPECT_EQ(state(1), paused_unknown);
  EXPECT_THAT(said_.back(), StartsWith("PAUSED_UNKNOWN: the abort was sent, but the mill's buffer may have been full, "
                                       "and a full buffer drops it; by the mill's profile what was executed ends "));
  EXPECT_EQ(by_[paused_unknown], "unix carl");
  ASSERT_TRUE(mill_.jobs()[0].written);
  EXPECT_TRUE(mill_.cancel(1, "unix bert", now_)) << "a person has looked";
}

// Flow control stops a host while the mill still has room.
TEST_F(MillAbortTest, AnAbortThatTheMillHeldBackEndsTheJob) {
  settings_.sending.flow_control = true;
  add(1);
  run_job(1, 20);
  run_for(1s);
  line_.busy = true;
  ASSERT_TRUE(mill_.abort({.who = "unix carl"}, now_));
  run_for(1s);
  EXPECT_EQ(state(1), aborted);
}

TEST_F(MillAbortTest, AnAbortThatTheMillTakesEndsTheJob) {
  settings_.sending.flow_control = true;
  settings_.sending.buffer = 64;
  add(1);
  run_job(1, 20);
  run_for(8s);
  ASSERT_TRUE(mill_.abort({.who = "unix carl"}, now_));
  run_for(1s);
  EXPECT_EQ(state(1), aborted);
}

}  // namespace
}  // namespace axisgate::rml1::mill_abort_test
