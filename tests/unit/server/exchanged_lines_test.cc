// Lines of a device that the journal collects, and the entries to which they belong.
#include "server/journal/exchanged_lines.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace axisgate::server::journal {
namespace {

using stage::AxisSet;
using stage::MotionState;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;

std::string text(const ExchangedLines::Line& line) {
  const std::string at = line.at ? fmt::format(" at {} ms", *line.at / milliseconds(1)) : "";
  return fmt::format("{}: {}{}", line.text, line.answer.value_or("(null)"), at);
}

std::vector<std::string> texts(const std::vector<ExchangedLines::Line>& lines) {
  std::vector<std::string> all;
  for (const ExchangedLines::Line& line : lines) all.push_back(text(line));
  return all;
}

class ExchangedLinesTest : public testing::Test {
 protected:
  void on(const stage::Event& event) {
    const auto apart = lines_.on_event(event, now_);
    if (!apart) return;
    for (const ExchangedLines::Line& line : apart->lines) {
      apart_.push_back(fmt::format("motion {} by {}: {}", apart->motion, apart->who, text(line)));
    }
  }
  void write(stage::BytesWritten written) {
    written.exchange = ++exchange_;
    now_ += milliseconds(1);
    on(written);
  }
  void answer(const std::string& line, const std::string& reply,
              stage::ExchangeEnded::Outcome outcome = stage::ExchangeEnded::Outcome::ok) {
    now_ += milliseconds(3);
    on(stage::ExchangeEnded{
        .command = {}, .line = line, .reply = reply, .outcome = outcome, .exchange = exchange_, .who = {}});
  }
  void exchange(const std::string& line, const std::string& reply, stage::MotionId motion = 0) {
    write({.bytes = line + "\r\n", .who = "unix anna", .motion = motion});
    answer(line, reply);
  }
  stage::Motion becomes(stage::MotionId id, MotionState state) {
    stage::Motion motion;
    motion.id = id;
    motion.state = state;
    motion.who = "unix anna";
    motion.created = kRequested;
    on(stage::MotionChanged{motion});
    return motion;
  }

  static constexpr TimePoint kRequested{std::chrono::seconds(5)};
  TimePoint now_ = kRequested;
  std::uint64_t exchange_ = 0;
  ExchangedLines lines_;
  std::vector<std::string> apart_;  // lines with their own entry
};

TEST_F(ExchangedLinesTest, OfAMotionTheStartAndTheEndHaveEachLineOnce) {
  becomes(12, MotionState::queued);
  exchange("A:1+P20000", "OK", 12);
  EXPECT_THAT(texts(lines_.take(becomes(12, MotionState::running))), ElementsAre("A:1+P20000: OK at 1 ms"));
  exchange("G:1", "NG", 12);
  EXPECT_THAT(texts(lines_.take(becomes(12, MotionState::failed))), ElementsAre("G:1: NG at 5 ms"));
  EXPECT_THAT(apart_, IsEmpty());
}

TEST_F(ExchangedLinesTest, InThePlaceOfAnAnswerThatDidNotComeIsWhy) {
  becomes(12, MotionState::queued);
  write({.bytes = "G:1\r\n", .who = {}, .motion = 12});
  answer("G:1", "", stage::ExchangeEnded::Outcome::timed_out);
  EXPECT_THAT(texts(lines_.take(becomes(12, MotionState::unknown))), ElementsAre("G:1: timed_out at 1 ms"));
}

TEST_F(ExchangedLinesTest, ALineThatIsInFlightAtTheEndHasNoAnswer) {
  becomes(12, MotionState::queued);
  write({.bytes = "G:1\r\n", .who = {}, .motion = 12});
  EXPECT_THAT(lines_.take(becomes(12, MotionState::running)), IsEmpty()) << "its answer may come";
  EXPECT_THAT(texts(lines_.take(becomes(12, MotionState::unknown))), ElementsAre("G:1: (null) at 1 ms"));
  answer("G:1", "OK");
  EXPECT_THAT(apart_, IsEmpty()) << "each is kept once";
}

TEST_F(ExchangedLinesTest, MotionsKeepTheirLinesApart) {
  becomes(1, MotionState::queued);
  becomes(2, MotionState::queued);
  exchange("M:1+P1", "OK", 1);
  exchange("M:2+P2", "OK", 2);
  EXPECT_THAT(texts(lines_.take(becomes(2, MotionState::running))), ElementsAre("M:2+P2: OK at 5 ms"));
  EXPECT_THAT(texts(lines_.take(becomes(1, MotionState::running))), ElementsAre("M:1+P1: OK at 1 ms"));
}

TEST_F(ExchangedLinesTest, BeyondSixtyFourTheyAreWrittenInTheirOrder) {
  becomes(1, MotionState::queued);
  for (int i = 1; i <= 130; ++i) exchange(fmt::format("MP:1+P{}", i), "OK_D", 1);
  ASSERT_EQ(apart_.size(), 128u);
  EXPECT_EQ(apart_.front(), "motion 1 by unix anna: MP:1+P1: OK_D at 1 ms");
  EXPECT_EQ(apart_.back(), "motion 1 by unix anna: MP:1+P128: OK_D at 509 ms");
  EXPECT_THAT(texts(lines_.take(becomes(1, MotionState::succeeded))),
              ElementsAre("MP:1+P129: OK_D at 513 ms", "MP:1+P130: OK_D at 517 ms"));
}

TEST_F(ExchangedLinesTest, ALineOfNoMotionIsApartAndAQuestionIsNot) {
  exchange("L:W", "OK");
  write({.bytes = "Q:S\r\n", .who = {}, .lane = Lane::poll, .question = true});
  answer("Q:S", "R,R,R", stage::ExchangeEnded::Outcome::data);
  EXPECT_THAT(apart_, ElementsAre("motion 0 by unix anna: L:W: OK"));
}

TEST_F(ExchangedLinesTest, AQuestionOfAMotionIsKeptWhileItLasts) {
  const stage::BytesWritten question{.bytes = "?:D1\r\n", .who = {}, .motion = 1, .question = true};
  becomes(1, MotionState::queued);
  write(question);
  answer("?:D1", "S1000F10000R100", stage::ExchangeEnded::Outcome::data);
  EXPECT_THAT(texts(lines_.take(becomes(1, MotionState::failed))), ElementsAre("?:D1: S1000F10000R100 at 1 ms"));
  write(question);
  answer("?:D1", "S1000F10000R100", stage::ExchangeEnded::Outcome::data);
  EXPECT_THAT(apart_, IsEmpty());
}

TEST_F(ExchangedLinesTest, ALineAfterTheEndOfItsMotionIsApartWithItsNumber) {
  becomes(1, MotionState::queued);
  (void)lines_.take(becomes(1, MotionState::stopped));
  exchange("D:1S1000F10000R100", "OK", 1);
  EXPECT_THAT(apart_, ElementsAre("motion 1 by unix anna: D:1S1000F10000R100: OK"));
}

// A stop in a barrier has no end event; probes belong to no exchange.
TEST_F(ExchangedLinesTest, AStopWithoutAnEndIsClosedByWhatFollows) {
  write({.bytes = "L:1\r\n", .who = "unix bert", .lane = Lane::stop});
  on(stage::BytesWritten{.bytes = "?:CMD\r\n", .who = {}, .question = true});
  EXPECT_THAT(apart_, IsEmpty());
  on(stage::LineLearned{stage::LineLearned::What::barrier_passed});
  EXPECT_THAT(apart_, ElementsAre("motion 0 by unix bert: L:1: (null)"));
  write({.bytes = "L:2\r\n", .who = "unix bert", .lane = Lane::stop});
  write({.bytes = "L:3\r\n", .who = "unix bert", .lane = Lane::stop});
  on(stage::LinkChanged{stage::LinkState::down, "the cable", {}, {}});
  EXPECT_THAT(apart_, ElementsAre("motion 0 by unix bert: L:1: (null)", "motion 0 by unix bert: L:2: (null)",
                                  "motion 0 by unix bert: L:3: (null)"));
}

// The !:S that closes an ambiguous answer, which could be a completion, has the number of its exchange.
TEST_F(ExchangedLinesTest, WhatClosesAnAnswerIsNoLineOfItsOwn) {
  becomes(1, MotionState::queued);
  write({.bytes = "?:A\r\n", .who = {}, .motion = 1, .closed = true, .question = true});
  on(stage::BytesWritten{
      .bytes = "!:S\r\n", .exchange = exchange_, .who = {}, .motion = 1, .closed = true, .question = true});
  answer("?:A", "2", stage::ExchangeEnded::Outcome::data);
  EXPECT_THAT(texts(lines_.take(becomes(1, MotionState::failed))), ElementsAre("?:A: 2 at 1 ms"));
}

}  // namespace
}  // namespace axisgate::server::journal
