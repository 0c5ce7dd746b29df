// Tests of the bytes written for a job and of their times: pause, abort, and a line that is stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "device/rml1/sending/commands.h"
#include "device/rml1/sending/sender.h"
#include "tests/rml1/fake_mill_line.h"
#include "tests/rml1/mill.h"
#include "tests/rml1/pieces.h"
#include "tests/rml1/sender_fixture.h"

namespace axisgate::rml1 {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;
using enum jobs::SenderState;

// Typed by hand from guideline 3-1, 3-3, 4-2 and 5-2. The highest speed of Z is 15 mm/s, the top is 0.
TEST(Words, OfAnAbort) {
  EXPECT_EQ(abort_commands(test_profile(), false), "\x1B.K\x1B.K^PA;!VZ15;!ZM0;!MC0;");
  EXPECT_EQ(abort_commands(test_profile(), true), "\x1B.K\x1B.K!MC0;^PA;!VZ15;!ZM0;!MC0;");
}

TEST(Words, AroundAJob) {
  EXPECT_EQ(prologue(), ";^DF;");
  EXPECT_EQ(epilogue(test_profile(), true), ";^PA;!VZ15;!ZM0;!MC0;^DF;!MC0;");
  EXPECT_EQ(epilogue(test_profile(), false), ";!MC0;^PA;!VZ15;!ZM0;!MC0;^DF;!MC0;");
}

// "When the cutting direction changes" (guideline 3-1 W): once per command, or before each of its points.
TEST(Timeline, HasADwellBeforeEachPointAtMost) {
  const Timeline with("^PA;W1000;PD1,0,2,0,3,0;", test_profile(), std::nullopt);
  const Timeline without("^PA;W0;PD1,0,2,0,3,0;", test_profile(), std::nullopt);
  EXPECT_FLOAT_EQ(static_cast<float>(sum_of(with, &Step::least_s) - sum_of(without, &Step::least_s)), 1);
  EXPECT_FLOAT_EQ(static_cast<float>(with.slowest_s() - without.slowest_s()), 3);
}

TEST_F(SenderTest, TheWholeJobIsWrittenOnceAndInCommands) {
  begin(vectors(40), {.slack = 1});
  run_for(std::chrono::seconds(60));
  EXPECT_EQ(sender_->state(), fed);
  EXPECT_EQ(written(), job_);
  EXPECT_EQ(line_.received, job_);
  EXPECT_EQ(line_.writes, pieces(job_));
  EXPECT_EQ(progress().executed_least, job_.size());
}

TEST_F(SenderTest, PacedNeverGoesBeyondItsWindow) {
  begin(vectors(200));
  EXPECT_EQ(sender_->run_on().at_most, 64u);
  EXPECT_EQ(sender_->run_on().if_held, 1024u + 512 + 2 * 9) << "the longest command has nine bytes";
  std::uint64_t most = 0;
  for (int i = 0; i < 20'000; ++i) {
    run_for(milliseconds(1));
    most = std::max(most, progress().written - progress().executed_least);
  }
  EXPECT_LE(most, 64u);
  EXPECT_GE(most, 55u) << "less than it may";
}

// A converter accepts all bytes at once, and its progress on the line is not visible.
TEST_F(SenderTest, PacedCountsTheTimeThatBytesNeedOnTheLine) {
  line_ = FakeMillLine(10'000'000);
  std::string job;
  for (int i = 0; i < 1000; ++i) job += "VS15;";
  begin(job, {.baud = 9600});
  for (int i = 0; i < 1000; ++i) {
    run_for(milliseconds(1));
    ASSERT_LE(progress().written, 960u * static_cast<unsigned>(i + 1) / 1000 + 64);
  }
  EXPECT_GE(progress().written, 900u) << "less than it may";
}

TEST_F(SenderTest, FullWritesWhatTheLineTakes) {
  begin(vectors(200), {.streaming = jobs::Streaming::full});
  run_for(std::chrono::seconds(3));
  EXPECT_EQ(sender_->state(), finishing);
  EXPECT_EQ(line_.received, job_);
}

// A pseudo-terminal, a serial server or a printer device behaves like this line: its queue is not visible.
TEST_F(SenderTest, FullDoesNotWaitForTheMillWhereTheLineHasTakenAll) {
  line_ = FakeMillLine(10'000'000);
  begin(vectors(200), {.streaming = jobs::Streaming::full});
  for (int calls = 0; calls < 1000 && sender_->state() == sending; ++calls) {
    line_.run_to(now_);
    ASSERT_LE(sender_->next_deadline(now_).value(), now_ + milliseconds(1)) << "it waits";
    run_for(milliseconds(1));
  }
  EXPECT_EQ(written(), job_);
}

TEST_F(SenderTest, WhileTheLineIsHeldOneCommandWaitsAtMost) {
  line_.busy = true;
  begin(vectors(20), {.streaming = jobs::Streaming::full});
  run_for(std::chrono::seconds(1));
  EXPECT_THAT(line_.writes, IsEmpty());
  line_.busy = false;
  run_for(milliseconds(20));
  line_.busy = true;
  const std::size_t before = line_.writes.size();
  run_for(std::chrono::seconds(1));
  EXPECT_EQ(line_.writes.size(), before);
  line_.busy = false;
  run_for(std::chrono::seconds(30));
  EXPECT_EQ(line_.received, job_);
}

TEST_F(SenderTest, APauseWritesNothingMoreAndSaysWhatStillRuns) {
  begin(vectors(200));
  run_for(std::chrono::seconds(5));
  sender_->pause();
  const std::uint64_t written = progress().written;
  EXPECT_EQ(sender_->state(), paused);
  EXPECT_GT(written, progress().executed_least);
  EXPECT_LE(progress().executed_least, progress().executed_most);
  run_for(std::chrono::seconds(20));
  EXPECT_EQ(progress().written, written);
  EXPECT_EQ(progress().executed_least, written) << "all that it had";
  sender_->resume(now_);
  run_for(std::chrono::seconds(600));
  EXPECT_EQ(line_.received, job_);
}

TEST_F(SenderTest, AfterAnAbortNothingOfTheJobIsWritten) {
  begin(vectors(200));
  run_for(std::chrono::seconds(5));
  line_.writes.clear();
  sender_->abort(now_);
  run_for(std::chrono::seconds(1));
  EXPECT_EQ(sender_->state(), aborted);
  EXPECT_EQ(written(), abort_commands(profile_, true)) << "the job has forbidden the spindle";
}

TEST_F(SenderTest, ATurningSpindleIsStoppedAfterTheRaise) {
  begin("^PA;V15;VS15;PU1000,0;PU0,0;PU1000,0;PU0,0;PU1000,0;PU0,0;PU1000,0;PU0,0;PU1000,0;PU0,0;PU1000,0;PU0,0;");
  run_for(std::chrono::seconds(8));
  line_.writes.clear();
  sender_->abort(now_);
  EXPECT_EQ(written(), abort_commands(profile_, false));
}

// The spindle does not turn before the first move.
TEST_F(SenderTest, OneThatMayRestIsStoppedBefore) {
  begin("^PA;V15;VS15;PU1000,0;PU0,0;");
  run_for(milliseconds(500));
  line_.writes.clear();
  sender_->abort(now_);
  EXPECT_THAT(written(), StartsWith("\x1B.K\x1B.K!MC0;"));
}

// !MC0 stops the spindle, and the dwell comes before it starts again (guideline 3-1 W, 5-2).
TEST_F(SenderTest, OneThatRestsInADwellIsStoppedBefore) {
  begin("^PA;V15;VS15;W500;PU500,0;PD1000,0;!MC0;!MC1;PD0,0;", {.window = 20});
  run_for(std::chrono::seconds(6));
  ASSERT_EQ(progress().written, job_.size() - 6) << "all but the last move";
  line_.writes.clear();
  sender_->abort(now_);
  EXPECT_EQ(written(), abort_commands(profile_, true));
}

TEST_F(SenderTest, AnAbortThatIsHeldIsSentAfterTwoHundredMilliseconds) {
  begin(vectors(200), {.streaming = jobs::Streaming::full});
  run_for(milliseconds(100));
  line_.busy = true;
  sender_->abort(now_);
  run_for(milliseconds(199));
  EXPECT_FALSE(line_.ignores);
  EXPECT_EQ(sender_->state(), aborting);
  run_for(milliseconds(100));
  EXPECT_EQ(sender_->state(), aborted);
  EXPECT_FALSE(line_.ignores) << "as it was before";
  EXPECT_THAT(line_.received, testing::EndsWith(abort_commands(profile_, true)));
}

// CTS became low before the last command had left the host.
TEST_F(SenderTest, WhatHasNotLeftTheHostIsNotFed) {
  begin(vectors(2), {.streaming = jobs::Streaming::full});
  run_for(milliseconds(20));
  while (sender_->state() == sending) run_for(milliseconds(1));
  ASSERT_EQ(sender_->state(), finishing);
  ASSERT_GT(line_.unsent(), 0u);
  line_.busy = true;
  run_for(std::chrono::seconds(60));
  EXPECT_EQ(sender_->state(), finishing);
  line_.busy = false;
  run_for(std::chrono::seconds(3));
  EXPECT_EQ(sender_->state(), fed);
}

// While CTS is low a mill has not executed everything: its buffer is full, or it is off.
TEST_F(SenderTest, WhileTheLineIsHeldNothingIsFed) {
  begin(vectors(2), {.streaming = jobs::Streaming::full});
  while (sender_->state() == sending || line_.unsent() > 0) run_for(milliseconds(1));
  line_.busy = true;
  run_for(std::chrono::seconds(60));
  EXPECT_EQ(sender_->state(), finishing);
  line_.busy = false;
  run_for(std::chrono::seconds(10));
  EXPECT_EQ(sender_->state(), fed);
}

// A move takes 0.9 s by the profile, and 1.5 times as long on the slowest mill.
TEST_F(SenderTest, AMoveIsTimedFromWhenItsBytesHaveLeft) {
  begin("!MC0;^PA;V15;VS15;PU1000,0;VS15;VS15;");
  while (progress().written < 27) run_for(milliseconds(1));
  line_.busy = true;
  run_for(std::chrono::seconds(10));
  EXPECT_LT(progress().executed_least, 27u) << "it has not left the host";
  line_.busy = false;
  run_for(std::chrono::seconds(1));
  EXPECT_LT(progress().executed_least, 27u) << "a mill that is slow is not there yet";
  run_for(std::chrono::seconds(2));
  EXPECT_GE(progress().executed_least, 27u);
}

TEST_F(SenderTest, ALostLineIsAnEndOfWhichNothingIsKnown) {
  begin(vectors(200));
  run_for(std::chrono::seconds(5));
  sender_->line_lost();
  EXPECT_EQ(sender_->state(), lost);
  const std::uint64_t written = progress().written;
  run_for(std::chrono::seconds(5));
  EXPECT_EQ(progress().written, written);
  sender_->abort(now_);
  EXPECT_EQ(sender_->state(), lost);
}

// The host's queue empties at any time, so a sender that looked at it again could write its last bytes and go to
// `finishing` after its job was found to be pausable.
TEST_F(SenderTest, APauseTakesTheStateThatWasChecked) {
  begin(vectors(4));
  while (line_.writes.size() < 2) run_for(milliseconds(1));
  const std::size_t before = line_.writes.size();
  line_.run_to(now_ += std::chrono::seconds(60));
  ASSERT_EQ(sender_->state(), sending);
  sender_->pause();
  EXPECT_EQ(sender_->state(), paused);
  EXPECT_EQ(line_.writes.size(), before);
}

// Typed by hand from README.md's table: the effect of each call in each state. All other calls have no effect.
TEST_F(SenderTest, TheTableOfStates) {
  const auto in = [this](jobs::SenderState state) {
    line_ = FakeMillLine();
    begin(vectors(4), {.slack = 1});
    switch (state) {
      case sending:
        break;
      case paused:
        sender_->pause();
        break;
      case finishing:
        for (int i = 0; i < 60'000 && sender_->state() == sending; ++i) run_for(milliseconds(1));
        break;
      case fed:
        run_for(std::chrono::seconds(60));
        break;
      case aborting:
        line_.busy = true;
        sender_->abort(now_);
        break;
      case aborted:
        sender_->abort(now_);
        run_for(std::chrono::seconds(1));
        break;
      case lost:
        sender_->line_lost();
        break;
      case raising:
        sender_->raise();
        break;
      case raised:
        sender_->raise();
        run_for(std::chrono::seconds(60));
        break;
      case ready:
        sender_.emplace(job_, *timeline_, profile_, jobs::SendSettings{}, plan_of(job_, *timeline_, {}),
                        beside_.mill());
    }
    ASSERT_EQ(sender_->state(), state);
  };
  const std::array<std::function<void()>, 6> kCalls = {
      [this] { sender_->start(now_); }, [this] { sender_->pause(); },     [this] { sender_->resume(now_); },
      [this] { sender_->abort(now_); }, [this] { sender_->line_lost(); }, [this] { sender_->raise(); }};
  struct Line {
    jobs::SenderState from;
    std::array<jobs::SenderState, 6> to;
  };
  const Line kTable[] = {
      {ready, {sending, ready, ready, ready, lost, ready}},
      {sending, {sending, paused, sending, aborting, lost, raising}},
      {paused, {paused, paused, sending, aborting, lost, raising}},
      {finishing, {finishing, finishing, finishing, aborting, lost, finishing}},
      {raising, {raising, raising, raising, aborting, lost, raising}},
      {raised, {raised, raised, raised, raised, raised, raised}},
      {fed, {fed, fed, fed, fed, fed, fed}},
      {aborting, {aborting, aborting, aborting, aborting, lost, aborting}},
      {aborted, {aborted, aborted, aborted, aborted, aborted, aborted}},
      {lost, {lost, lost, lost, lost, lost, lost}},
  };
  for (const Line& row : kTable) {
    for (std::size_t call = 0; call < kCalls.size(); ++call) {
      in(row.from);
      kCalls.at(call)();
      EXPECT_EQ(sender_->state(), row.to.at(call)) << name(row.from) << ", call " << call;
    }
  }
}

}  // namespace
}  // namespace axisgate::rml1
