// End of the motions that a killed run left open: in the journal, and as facts for watchers that resume.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/devices/after_crash.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::after_crash_facts_test {
namespace {

using journal::Entry;
using journal::EntryKind;
using journal::Journal;
using stage::MotionState;

const WallTime kNoon = std::chrono::sys_days(std::chrono::year(2026) / 11 / 24) + std::chrono::hours(12);
const TimePoint kBegun{std::chrono::seconds(100)};

FactPointer running(std::uint64_t revision, stage::MotionId id) {
  stage::Motion motion;
  motion.id = id;
  motion.state = MotionState::running;
  motion.who = "unix anna";
  motion.segments_total = 20;
  motion.created = kBegun;
  return std::make_shared<const FactRecord>(
      FactRecord{revision, "stage", kNoon, stage::MotionChanged{motion}, {kBegun, kNoon}, "before"});
}

class AfterCrashFacts : public testing::Test {
 protected:
  void append(EntryKind kind, stage::MotionId motion, std::string body) {
    journal_->append({{.kind = kind,
                       .time = kNoon,
                       .boot_time = kBegun,
                       .device = "stage",
                       .who = "unix anna",
                       .motion = motion,
                       .body = std::move(body)}});
  }
  // Settles with the facts that the previous run wrote and `started`, the motions that its MotionRecord returns.
  void settle(std::vector<FactPointer> facts, const std::optional<StartedMotions>& started) {
    bus_ = std::make_unique<EventBus>([](std::function<void()>) {}, "now", FactsBefore{std::move(facts), 10});
    settle_what_was_left(journal_.get(), requests_, *bus_, [&](std::string_view) { return started; });
  }
  const stage::Motion& ended(stage::MotionId id) {
    const FactPointer newest = bus_->find_motion("stage", id);
    EXPECT_GE(newest->revision, 10u) << "published by this run";
    return std::get<stage::MotionChanged>(newest->fact).motion;
  }

  const link_test::TemporaryDirectory directory_;
  const std::unique_ptr<Journal> journal_ = *Journal::open(directory_ / "journal.sqlite");
  journal::RequestMemory requests_{{}, "epoch", Duration::zero()};
  std::unique_ptr<EventBus> bus_;
};

TEST_F(AfterCrashFacts, WhatWasStartedIsUnknownAsAFact) {
  append(EntryKind::motion_requested, 7, R"({"axes":[1],"kind":"path"})");
  settle({running(3, 7)}, StartedMotions{{{7, MotionState::running, "unix anna", ""}}});
  const stage::Motion& motion = ended(7);
  EXPECT_EQ(motion.state, MotionState::unknown);
  EXPECT_EQ(motion.problem->reason, Reason::outcome_unknown);
  EXPECT_EQ(motion.segments_total, 20) << "as its newest fact had it";
  EXPECT_GT(bus_->find_motion("stage", 7)->clock.at(motion.ended), kNoon);
  EXPECT_TRUE(bus_->open_motions().empty());
}

TEST_F(AfterCrashFacts, WhatWasNotStartedIsNotSent) {
  append(EntryKind::motion_requested, 7, R"({"axes":[1],"kind":"move"})");
  settle({running(3, 7)}, StartedMotions{});
  EXPECT_EQ(ended(7).state, MotionState::failed);
  EXPECT_EQ(ended(7).problem->reason, Reason::not_sent);
}

TEST_F(AfterCrashFacts, WithoutAFactItIsAsItsRequest) {
  append(EntryKind::motion_requested, 7, R"({"axes":[1,3,99,"x"],"kind":"home","request_id":"h-1"})");
  append(EntryKind::motion_requested, 8, "no JSON");
  settle({}, std::nullopt);
  const stage::Motion& motion = ended(7);
  EXPECT_EQ(motion.state, MotionState::unknown);
  EXPECT_EQ(motion.kind, stage::MotionKind::home);
  EXPECT_EQ(motion.axes, stage::AxisSet::of(1) | stage::AxisSet::of(3));
  EXPECT_EQ(motion.who, "unix anna");
  EXPECT_EQ(motion.request_id, "h-1");
  EXPECT_EQ(bus_->find_motion("stage", 7)->clock.at(motion.created), kNoon);
  EXPECT_EQ(ended(8).state, MotionState::unknown);
}

// The daemon was killed after it had written the journal entry but before it wrote the fact.
TEST_F(AfterCrashFacts, AnEndThatTheJournalHasIsAFact) {
  for (const stage::MotionId id : {7, 8, 9, 10})
    append(EntryKind::motion_requested, id, R"({"axes":[1],"kind":"move"})");
  append(EntryKind::motion_ended, 7, R"({"axes":[1],"outcome":"SUCCEEDED"})");
  append(EntryKind::motion_ended, 8, R"({"axes":[1],"outcome":"STOPPED","reason":"STOPPED"})");
  append(EntryKind::motion_ended, 9, R"({"axes":[1],"outcome":"RAN AWAY"})");
  append(EntryKind::motion_ended, 10, R"({"axes":[1],"outcome":"RUNNING"})");
  settle({running(3, 7), running(4, 8), running(5, 9), running(6, 10)}, std::nullopt);
  EXPECT_EQ(ended(7).state, MotionState::succeeded);
  EXPECT_FALSE(ended(7).problem);
  EXPECT_EQ(ended(8).state, MotionState::stopped);
  EXPECT_EQ(ended(8).problem->reason, Reason::stopped);
  EXPECT_EQ(ended(9).state, MotionState::unknown) << "somebody has changed the file";
  EXPECT_EQ(ended(10).state, MotionState::unknown) << "likewise";
}

TEST_F(AfterCrashFacts, WhatHadEndedIsNoFactAgain) {
  append(EntryKind::motion_requested, 7, R"({"axes":[1],"kind":"move"})");
  append(EntryKind::motion_ended, 7, R"({"axes":[1],"outcome":"SUCCEEDED"})");
  settle({}, std::nullopt);
  EXPECT_EQ(bus_->newest_revision(), 9u);
}

}  // namespace
}  // namespace axisgate::server::after_crash_facts_test
