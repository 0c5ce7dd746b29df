// Conversion of a controller's events to the lines of a recording.
#include "device/stage/recording/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace axisgate::stage::recorder_test {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

class RecorderTest : public testing::Test {
 protected:
  void tell(const Event& event) { recorder_.on_event(event, began_ + milliseconds(now_)); }
  void write(std::uint64_t exchange, std::string bytes, std::string who = "") {
    BytesWritten written;
    written.bytes = std::move(bytes);
    written.exchange = exchange;
    written.who = std::move(who);
    tell(written);
  }
  void receive(std::string bytes) { tell(BytesReceived{std::move(bytes)}); }
  void end(std::uint64_t exchange, ExchangeEnded::Outcome outcome) {
    ExchangeEnded ended;
    ended.exchange = exchange;
    ended.outcome = outcome;
    tell(ended);
  }
  const std::vector<std::string>& lines() {
    recorder_.flush();
    return lines_;
  }

  const TimePoint began_{std::chrono::seconds(1000)};
  std::int64_t now_ = 0;  // milliseconds since began_
  std::vector<std::string> lines_;
  Recorder recorder_{{}, began_, [this](std::string line) { lines_.push_back(std::move(line)); }};
};

TEST_F(RecorderTest, AnExchangeIsALine) {
  now_ = 1500;
  BytesWritten written{"G:A\r\n", 7, "lab", Lane::motion, AxisSet::of(1) | AxisSet::of(2)};
  tell(written);
  now_ = 1504;
  receive("O");
  now_ = 1505;
  receive("K\r\n1\r\n");
  ExchangeEnded ended;
  ended.exchange = 7;
  ended.waited = milliseconds(20);
  tell(ended);
  tell(CompletionSeen{1, 3});
  EXPECT_THAT(lines_, IsEmpty());
  EXPECT_THAT(lines(), ElementsAre("1.500000 #7 motion \"lab\" waited 0.020000 completes 1,2 > \"G:A\\r\\n\" "
                                   "+0.005000 < \"OK\\r\\n1\\r\\n\" = ok completion 1"));
}

TEST_F(RecorderTest, ALineIsFinishedByTheNext) {
  write(1, "?:V\r\n", "lab");
  receive("V2\r\n");
  end(1, ExchangeEnded::Outcome::data);
  write(2, "!:\r\n", "lab");
  EXPECT_THAT(lines_, SizeIs(1));
  receive("R\r\n");
  end(2, ExchangeEnded::Outcome::data);
  tell(BarrierEntered{"why"});
  EXPECT_THAT(lines_, SizeIs(3));
}

TEST_F(RecorderTest, WhatComesByItselfHasLinesOfItsOwn) {
  write(1, "?:V\r\n", "lab");
  receive("V2\r\n");
  end(1, ExchangeEnded::Outcome::data);
  receive("1");
  receive("\r\n");
  tell(CompletionSeen{1, 0});
  now_ = 200;
  receive("OK\r\n");
  tell(UnexpectedLine{"OK"});
  now_ = 300;
  tell(UnexpectedLine{"(a line that did not end)"});
  EXPECT_THAT(lines(), ElementsAre("0.000000 #1 question \"lab\" > \"?:V\\r\\n\" < \"V2\\r\\n\" = data",
                                   "0.000000 - < \"1\\r\\n\" completion 1",
                                   "0.200000 - < \"OK\\r\\n\" unexpected \"OK\" "
                                   "+0.100000 unexpected \"(a line that did not end)\""));
}

// A line that arrives byte by byte is recorded like a line that arrives at once.
TEST_F(RecorderTest, BytesOfALineAreOnePiece) {
  write(1, "?:V\r\n", "lab");
  for (const std::string byte : {"V", "2", "\r"}) {
    now_ += 2;
    receive(byte);
  }
  end(1, ExchangeEnded::Outcome::data);
  now_ += 2;
  receive("\n");
  for (const std::string byte : {"1", "\r"}) {
    now_ += 2;
    receive(byte);
  }
  tell(CompletionSeen{1, 0});
  receive("\n");
  EXPECT_THAT(
      lines(),
      ElementsAre("0.000000 #1 question \"lab\" > \"?:V\\r\\n\" +0.006000 < \"V2\\r\" = data +0.008000 < \"\\n\"",
                  "0.010000 - +0.002000 < \"1\\r\" completion 1 < \"\\n\""));
}

// The core takes a line as complete at its CR, so the piece has the time of the CR.
TEST_F(RecorderTest, APieceCameWithItsCarriageReturn) {
  write(0, "*IDN?\r\n");
  now_ = 3;
  receive("A,B");
  now_ = 4;
  receive("\r");
  now_ = 5;
  receive("\n");
  EXPECT_THAT(lines(), ElementsAre("0.000000 - > \"*IDN?\\r\\n\" +0.004000 < \"A,B\\r\\n\""));
}

TEST_F(RecorderTest, ALongPauseDividesALine) {
  write(1, "?:V\r\n", "lab");
  receive("V");
  now_ = 16;
  receive("2");
  now_ = 17;
  receive(".\r\n");
  end(1, ExchangeEnded::Outcome::data);
  EXPECT_THAT(lines(), ElementsAre("0.000000 #1 question \"lab\" > \"?:V\\r\\n\" +0.016000 < \"V2\" "
                                   "+0.017000 < \".\\r\\n\" = data"));
}

TEST_F(RecorderTest, AProbeBelongsToNoExchange) {
  write(1, "?:V\r\n", "lab");
  end(1, ExchangeEnded::Outcome::timed_out);
  tell(BarrierEntered{"not \"answered\""});
  write(0, "?:CMD\r\n");
  receive("?:V\r\n");
  write(0, "*IDN?\r\n");
  write(2, "L:D\r\n", "stopper");
  write(0, "*IDN?\r\n");
  receive("OK\r\n");
  tell(LineLearned{LineLearned::What::barrier_passed});
  EXPECT_THAT(lines(),
              ElementsAre("0.000000 #1 question \"lab\" > \"?:V\\r\\n\" = timed_out",
                          "# 0.000000 barrier \"not \\\"answered\\\"\"", "0.000000 - > \"?:CMD\\r\\n\" < \"?:V\\r\\n\"",
                          "0.000000 - > \"*IDN?\\r\\n\"", "0.000000 #2 question \"stopper\" > \"L:D\\r\\n\"",
                          "0.000000 - > \"*IDN?\\r\\n\" < \"OK\\r\\n\"", "# 0.000000 barrier passed"));
}

TEST_F(RecorderTest, AnInterruptedExchangeGoesOnWithItsNumber) {
  write(9, "I:\r\n", "lab");
  receive("2\r\n");
  write(9, "!:S\r\n", "lab");
  tell(LineLearned{LineLearned::What::ready, AxisSet::of(3)});
  now_ = 10;
  receive("R\r\n");
  end(9, ExchangeEnded::Outcome::data);
  EXPECT_THAT(lines(), ElementsAre("0.000000 #9 question \"lab\" > \"I:\\r\\n\" < \"2\\r\\n\" > \"!:S\\r\\n\"",
                                   "# 0.000000 ready 3", "0.010000 #9 < \"R\\r\\n\" = data"));
}

TEST_F(RecorderTest, AFloodIsNotKeptBack) {
  constexpr int kBytes = 100'000, kLineBytesMax = 64 * 256;
  write(9, "I:\r\n", "lab");
  for (int i = 0; i < kBytes; ++i) receive("x");
  EXPECT_EQ(lines_.size(), kBytes / kLineBytesMax);
  end(9, ExchangeEnded::Outcome::garbled);
  std::int64_t bytes = 0;
  for (const auto& line : lines()) {
    bytes += std::ranges::count(line, 'x');
    EXPECT_TRUE(line.starts_with("0.000000 #9 ")) << line;
  }
  EXPECT_EQ(bytes, kBytes);
}

TEST_F(RecorderTest, TheLinksStoryIsKept) {
  tell(LinkChanged{LinkState::connecting, "the line is open"});
  tell(LinkChanged{LinkState::up, "", AxisSet::of(2)});
  write(1, "?:V\r\n", "lab");
  receive("V2.");
  end(1, ExchangeEnded::Outcome::link_lost);
  tell(LinkChanged{LinkState::down, "pulled"});
  EXPECT_THAT(lines(), ElementsAre("# 0.000000 link connecting", "# 0.000000 link up 2",
                                   "0.000000 #1 question \"lab\" > \"?:V\\r\\n\" < \"V2.\" = link_lost",
                                   "# 0.000000 link down \"pulled\""));
}

TEST_F(RecorderTest, ANumberFoundInAnAnswerIsNotToldTwice) {
  tell(CompletionSeen{1, 0, true});
  EXPECT_THAT(lines(), IsEmpty());
}

// The header is that of a file begun now.
TEST_F(RecorderTest, KnowsTheHeaderOfWhatIsToCome) {
  tell(LinkChanged{LinkState::up, "", AxisSet::of(2)});
  EXPECT_EQ(recorder_.header().axes, AxisSet::of(2));
  tell(BytesWritten{"G:2\r\n", 1, "lab", Lane::motion, AxisSet::of(2)});
  EXPECT_TRUE(recorder_.header().may_complete.empty());
  recorder_.flush();
  EXPECT_EQ(recorder_.header().may_complete, AxisSet::of(2));
}

}  // namespace
}  // namespace axisgate::stage::recorder_test
