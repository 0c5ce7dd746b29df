#include "device/shot/line/line_timing.h"

#include <gtest/gtest.h>

#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203::line_timing_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

// 10,000 baud: a millisecond a byte.
class PaceTest : public testing::Test {
 protected:
  // Records an exchange of 5 bytes sent and 4 received, terminators included.
  void answered_in(Duration turnaround) { timing.answered(3, 2, milliseconds(9) + turnaround); }

  LineTiming timing{10'000, 3};
};

TEST_F(PaceTest, TenBitsAByte) {
  EXPECT_EQ(timing.time_of(48), milliseconds(48));
  EXPECT_EQ(LineTiming(38400, 3).time_of(384), milliseconds(100));
  EXPECT_EQ(LineTiming(38400, 3).reply_bytes_max(), 64u);
  EXPECT_EQ(LineTiming(38400, 8).reply_bytes_max(), 169u);
}

TEST_F(PaceTest, TheTurnaroundIsWhatTheBytesDoNotExplain) {
  EXPECT_EQ(timing.usual_turnaround(), kTurnaroundAssumed);
  EXPECT_EQ(timing.longest_turnaround(), kTurnaroundAssumed);
  for (const int time : {3, 2, 40}) answered_in(milliseconds(time));
  EXPECT_EQ(timing.usual_turnaround(), milliseconds(3));
  EXPECT_EQ(timing.longest_turnaround(), milliseconds(40));
  timing.connected();
  EXPECT_EQ(timing.longest_turnaround(), kTurnaroundAssumed) << "of other cables";
}

TEST_F(PaceTest, ALineFasterThanItsBaudRateHasNoTurnaround) {
  timing.answered(3, 2, microseconds(50));
  EXPECT_EQ(timing.longest_turnaround(), Duration::zero());
}

TEST_F(PaceTest, OneSlowAnswerIsForgotten) {
  answered_in(seconds(1));
  for (std::size_t i = 1; i < LineTiming::kKept; ++i) answered_in(milliseconds(1));
  EXPECT_EQ(timing.longest_turnaround(), seconds(1));
  answered_in(milliseconds(1));
  EXPECT_EQ(timing.longest_turnaround(), milliseconds(1));
}

TEST_F(PaceTest, AnExchangeLastsAsLongAsItsLongestReply) {
  answered_in(milliseconds(7));
  EXPECT_EQ(timing.longest_exchange(model().make("?:V")), milliseconds(3 + 2 + 64 + 2 + 7));
  // The answer is OK_D or NG; after NG comes ?:CMD, which is answered with the line.
  EXPECT_EQ(timing.longest_exchange(model().make("G:", AxisSet::of(1))),
            milliseconds(3 + 2 + 4 + 2 + 7) + milliseconds(5 + 2 + 3 + 2 + 7));
}

}  // namespace
}  // namespace axisgate::shrc203::line_timing_test
