// The record that a killed daemon leaves of its motions, and the parts of it that the next daemon believes.
#include "server/devices/motion_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

namespace axisgate::server::motion_record_test {
namespace {

using stage::AxisSet;
using stage::BytesWritten;
using stage::LinkChanged;
using stage::LinkState;
using stage::Motion;
using stage::MotionChanged;
using stage::MotionKind;
using stage::MotionState;
using stage::UnfinishedJudged;
using testing::ElementsAre;

class MotionRecordTest : public testing::Test {
 protected:
  ~MotionRecordTest() override { std::filesystem::remove_all(folder_); }

  void start(const std::string& boot = "boot-1") {
    record_.reset();
    auto opened = MotionRecord::open(path_, boot);
    ASSERT_TRUE(opened) << opened.error().message;
    record_ = *std::move(opened);
  }
  void connect() { record_->on_event(LinkChanged{LinkState::up, "", AxisSet::first(3), "2106001001"}); }
  void motion(MotionKind kind, AxisSet axes, MotionState state, stage::MotionId id = 7) {
    Motion changed;
    changed.id = id;
    changed.kind = kind;
    changed.state = state;
    changed.axes = axes;
    changed.who = "unix anna";
    record_->on_event(MotionChanged{changed});
  }
  void write(const std::string& line, AxisSet completes = {}) {
    BytesWritten written;
    written.bytes = line + "\r\n";
    written.completes = completes;
    record_->on_event(written);
  }
  const std::optional<stage::Unfinished>& unfinished() const { return record_->unfinished(); }

  const std::string folder_ = [] {
    std::string name = testing::TempDir() + "axisgate-record-XXXXXX";
    return std::string(::mkdtemp(name.data()));
  }();
  const std::string path_ = folder_ + "/motions-stage";
  std::unique_ptr<MotionRecord> record_;
};

TEST_F(MotionRecordTest, WhatRanIsLeftWithTheLastLines) {
  start();
  EXPECT_FALSE(unfinished());
  connect();
  motion(MotionKind::move, AxisSet::of(1), MotionState::running);
  motion(MotionKind::jog, AxisSet::of(3), MotionState::running, 8);
  for (const char* line : {"G:1", "J:3+", "Q:SP"}) write(line);
  start();
  ASSERT_TRUE(unfinished());
  EXPECT_EQ(unfinished()->serial_number, "2106001001");
  EXPECT_EQ(unfinished()->moving, AxisSet::of(1) | AxisSet::of(3));
  EXPECT_EQ(unfinished()->jogged, AxisSet::of(3));
  EXPECT_EQ(unfinished()->motions, "motion 7 (move, asked by unix anna), motion 8 (jog, asked by unix anna)");
  EXPECT_THAT(unfinished()->last_lines, ElementsAre("Q:SP", "J:3+", "G:1"));
}

// The controller's last line is the newest answered line or one written since, because probes into a dead line may have
// been lost. The controller may not remember a line that it refused.
TEST_F(MotionRecordTest, TheLastLinesAreThoseSinceTheLastAnswer) {
  using Outcome = stage::ExchangeEnded::Outcome;
  start();
  connect();
  motion(MotionKind::move, AxisSet::of(1), MotionState::running);
  const auto exchange = [this](const char* line, Outcome outcome) {
    write(line);
    stage::ExchangeEnded ended;
    ended.line = line;
    ended.outcome = outcome;
    record_->on_event(ended);
  };
  exchange("MP:1+P1000", Outcome::ok);
  exchange("G:1", Outcome::ok);
  exchange("L:1", Outcome::ng);
  for (int probe = 0; probe < 40; ++probe) write(probe % 2 == 0 ? "?:CMD" : "*IDN?");
  start();
  ASSERT_TRUE(unfinished());
  EXPECT_THAT(unfinished()->last_lines, ElementsAre("*IDN?", "?:CMD", "L:1", "G:1"));
}

// The axis counts as moving until a handshake has found everything stationary.
TEST_F(MotionRecordTest, AMotionThatEndedUnknownMayMove) {
  start();
  connect();
  stage::Motion unknown;
  unknown.id = 7;
  unknown.axes = AxisSet::of(2);
  unknown.written = true;
  unknown.state = MotionState::unknown;
  unknown.who = "unix anna";
  record_->on_event(stage::MotionChanged{unknown});
  start();
  ASSERT_TRUE(unfinished());
  EXPECT_EQ(unfinished()->moving, AxisSet::of(2));
  record_->on_event(UnfinishedJudged{UnfinishedJudged::What::stationary, AxisSet::of(2), ""});
  record_->on_event(stage::MotionChanged{unknown});
  connect();
  start();
  EXPECT_FALSE(unfinished());
}

TEST_F(MotionRecordTest, WhatWasStartedAndNotAnsweredMayMove) {
  start();
  connect();
  motion(MotionKind::jog, AxisSet::of(2), MotionState::queued);
  write("J:2+", AxisSet::of(2));
  start();
  ASSERT_TRUE(unfinished());
  EXPECT_EQ(unfinished()->moving, AxisSet::of(2));
  EXPECT_EQ(unfinished()->jogged, AxisSet::of(2));
}

TEST_F(MotionRecordTest, WhatWaitsOrHasEndedIsNotLeft) {
  start();
  connect();
  motion(MotionKind::move, AxisSet::of(1), MotionState::queued);
  write("Q:SP");
  start();
  EXPECT_FALSE(unfinished());
  motion(MotionKind::move, AxisSet::of(1), MotionState::running);
  motion(MotionKind::move, AxisSet::of(1), MotionState::succeeded);
  start();
  EXPECT_FALSE(unfinished());
}

TEST_F(MotionRecordTest, NothingIsInheritedFromBeforeABoot) {
  start();
  connect();
  motion(MotionKind::move, AxisSet::of(1), MotionState::running);
  start("boot-2");
  EXPECT_FALSE(unfinished());
  start("");
  EXPECT_FALSE(unfinished());
}

// The daemon was killed again before the axes were stationary.
TEST_F(MotionRecordTest, ItIsKeptUntilItIsKnownWhatBecameOfIt) {
  start();
  connect();
  motion(MotionKind::move, AxisSet::of(1), MotionState::running);
  start();
  write("L:1");
  record_->on_event(UnfinishedJudged{UnfinishedJudged::What::stopped, AxisSet::of(1), ""});
  start();
  ASSERT_TRUE(unfinished());
  EXPECT_EQ(unfinished()->moving, AxisSet::of(1));
  EXPECT_EQ(unfinished()->serial_number, "2106001001");
  EXPECT_THAT(unfinished()->last_lines, ElementsAre("L:1"));
  record_->on_event(UnfinishedJudged{UnfinishedJudged::What::stationary, AxisSet::of(1), ""});
  start();
  EXPECT_FALSE(unfinished());
}

TEST_F(MotionRecordTest, TextOfSomebodyElseIsNoMotion) {
  for (const std::string& text :
       {std::string(10'000, 'x'), std::string("0axisgate motions 1\nboot boot-1\nmoving 255\n"),
        std::string("0axisgate motions 1\nboot boot-1\nmoving -9\nend\n"), std::string()}) {
    std::ofstream(path_, std::ios::trunc) << text;
    ASSERT_EQ(::chmod(path_.c_str(), 0600), 0);
    start();
    EXPECT_FALSE(unfinished()) << text.substr(0, 50);
  }
}

TEST_F(MotionRecordTest, ALongNameDoesNotBreakTheText) {
  start();
  connect();
  for (stage::MotionId id = 1; id <= 50; ++id) motion(MotionKind::move, AxisSet::of(1), MotionState::running, id);
  write(std::string(4'000, 'x') + "\nend");
  start();
  ASSERT_TRUE(unfinished());
  EXPECT_EQ(unfinished()->moving, AxisSet::of(1));
}

TEST_F(MotionRecordTest, WhatIsNoRegularFileIsRefused) {
  std::filesystem::create_symlink("/etc/passwd", path_);
  EXPECT_FALSE(MotionRecord::open(path_, "boot-1"));
}

}  // namespace
// The journal may not have the number yet. A motion that only waited was not started, but may have been shown.
TEST_F(MotionRecordTest, TheHighestNumberOfAMotionOutlivesRuns) {
  start();
  EXPECT_EQ(record_->last_motion(), 0u);
  motion(MotionKind::move, AxisSet::of(1), MotionState::queued, 12);
  motion(MotionKind::move, AxisSet::of(1), MotionState::failed, 11);
  start();
  EXPECT_EQ(record_->last_motion(), 12u);
  motion(MotionKind::move, AxisSet::of(1), MotionState::queued, 3);
  start();
  EXPECT_EQ(record_->last_motion(), 12u);
}

// The journal may lack the ends of these motions, even of those before the previous run.
TEST_F(MotionRecordTest, StartedMotionsOutliveRunsAndTheOldestAreDropped) {
  const auto run = [this](stage::MotionId id) {
    motion(MotionKind::move, AxisSet::of(1), MotionState::queued, id);
    BytesWritten line;
    line.motion = id;
    record_->on_event(line);
    motion(MotionKind::move, AxisSet::of(1), MotionState::succeeded, id);
  };
  start();
  for (stage::MotionId id = 1; id <= 10; ++id) run(id);
  start();
  for (stage::MotionId id = 11; id <= 20; ++id) run(id);
  start();
  const std::optional<StartedMotions>& before = record_->started_before();
  ASSERT_TRUE(before);
  EXPECT_EQ(before->dropped_through, 4u);
  ASSERT_EQ(before->kept.size(), 16u);
  EXPECT_EQ(before->kept.front().motion, 5u);
  EXPECT_EQ(before->kept.front().state, MotionState::succeeded);
}

}  // namespace axisgate::server::motion_record_test
