// Tests of the number of bytes of a job that are reported to be in the mill, by the model and by the line.
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <string>

#include "tests/rml1/fake_mill_line.h"
#include "tests/rml1/sender_fixture.h"

namespace axisgate::rml1::taken_test {
namespace {

using std::chrono::milliseconds;

class Taken : public SenderTest {};

TEST_F(Taken, WhatAConverterCannotHoldIsTaken) {
  begin(vectors(200), {.streaming = jobs::Streaming::full, .converter = 100, .flow_control = true});
  run_for(milliseconds(200));
  const std::size_t left = line_.received.size();
  ASSERT_GT(left, 150u);
  EXPECT_EQ(progress().taken, left - 100);
  EXPECT_LT(progress().executed_least, left - 100);
  line_.busy = true;
  run_for(milliseconds(500));
  EXPECT_EQ(progress().taken, left - 100) << "nothing leaves the host";
}

TEST_F(Taken, WithoutFlowControlOnlyWhatIsExecutedIsTaken) {
  begin(vectors(200), {.streaming = jobs::Streaming::full, .converter = 100});
  for (int i = 0; i < 100; ++i) {
    run_for(milliseconds(100));
    ASSERT_EQ(progress().taken, progress().executed_least);
  }
  EXPECT_GT(progress().taken, 20u);
}

// The mill may have no room for bytes sent against flow control.
TEST_F(Taken, WhatAnAbortPushesIntoAFullBufferIsNotTaken) {
  begin(vectors(200), {.streaming = jobs::Streaming::full, .converter = 0, .flow_control = true});
  run_for(milliseconds(200));
  line_.busy = true;
  ASSERT_GT(line_.unsent(), 0u);
  const std::size_t left = line_.received.size();
  sender_->abort(now_);
  run_for(milliseconds(500));
  ASSERT_EQ(sender_->state(), jobs::SenderState::aborted);
  EXPECT_EQ(progress().taken, left);
}

// These bytes are no evidence either that the mill has read the bytes before them.
TEST_F(Taken, WhatAnAbortPushesIntoAFullBufferIsNotExecuted) {
  std::string list = "PD0,0";
  for (int i = 1; i < 60; ++i) list += ",1000,0,0,0";
  begin(vectors(10) + list + ";",
        {.streaming = jobs::Streaming::full, .buffer = 100, .converter = 0, .flow_control = true});
  run_for(milliseconds(120));
  line_.busy = true;
  const std::uint64_t executed = progress().executed_least;
  ASSERT_GT(progress().written, 150u);
  ASSERT_LT(line_.received.size(), 130u);
  sender_->abort(now_);
  run_for(milliseconds(1000));
  ASSERT_EQ(sender_->state(), jobs::SenderState::aborted);
  ASSERT_GT(line_.received.size(), 150u);
  EXPECT_EQ(progress().executed_least, executed);
}

TEST_F(Taken, WhatIsDiscardedWithTheLineIsNotTaken) {
  begin(vectors(200), {.streaming = jobs::Streaming::full, .converter = 0, .flow_control = true});
  run_for(milliseconds(200));
  ASSERT_GT(line_.unsent(), 0u);
  const std::size_t left = line_.received.size();
  line_ = FakeMillLine();  // device/link discards waiting bytes in the same manner
  sender_->line_lost();
  EXPECT_EQ(progress().taken, left);
}

}  // namespace
}  // namespace axisgate::rml1::taken_test
