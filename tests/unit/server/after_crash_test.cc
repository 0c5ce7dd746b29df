// Requests that the killed previous run left without an end, and their treatment by the next run.
#include "server/devices/after_crash.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/journal/answers.h"
#include "server/journal/store.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::after_crash_test {
namespace {

using journal::MemoryBounds;
using journal::RememberedRequest;
using journal::RequestMemory;
using stage::MotionState;
using Started = std::optional<StartedMotions>;

constexpr TimePoint kMorning{std::chrono::hours(8)};

RememberedRequest request_of(std::string id, std::uint64_t motion) {
  return {.identity = "unix anna",
          .id = std::move(id),
          .number = 1,
          .digest = "1 mm",
          .device = "stage",
          .moves = true,
          .motion = motion};
}

StartedMotion started(stage::MotionId motion, MotionState state, std::string id = "align-17") {
  return {motion, state, "unix anna", std::move(id)};
}

// Returns the answer to a repeat of `left` after the crash; nullopt if the repeat is executed.
std::optional<stage::Motion> answer_to_repeat(const RememberedRequest& left, const Started& started) {
  RequestMemory memory(MemoryBounds{}, "first", Duration::zero(), {{left}, 0});
  EventBus bus([](std::function<void()>) {});
  settle_what_was_left(nullptr, memory, bus, [&](std::string_view) { return started; });
  std::optional<stage::Motion> answer;
  const auto begun = memory.begin(left, "", kMorning, [&](const Result<RequestMemory::Known>& known) {
    answer = journal::motion_in(known->answer);
    EXPECT_EQ(known->motion, answer->id);
  });
  EXPECT_EQ(begun->has_value(), !answer.has_value());
  return answer;
}

TEST(AfterCrash, WhatWasNotStartedMayBeRequestedAgain) {
  EXPECT_FALSE(answer_to_repeat(request_of("align-17", 12), StartedMotions()));
  EXPECT_FALSE(answer_to_repeat(request_of("align-17", 0), StartedMotions()));
}

TEST(AfterCrash, WhatWasStartedIsNotDoneAgain) {
  for (const MotionState state : {MotionState::queued, MotionState::running, MotionState::stopped, MotionState::failed,
                                  MotionState::succeeded, MotionState::unknown}) {
    const auto answer = answer_to_repeat(request_of("align-17", 12), StartedMotions{{started(12, state)}});
    ASSERT_TRUE(answer) << name(state);
    EXPECT_EQ(answer->id, 12u);
    EXPECT_EQ(answer->state, is_outcome(state) ? state : MotionState::unknown);
  }
}

TEST(AfterCrash, WithoutARecordNothingIsDoneAgain) {
  EXPECT_TRUE(answer_to_repeat(request_of("align-17", 12), std::nullopt));
}

// The first motion with the id was refused before its start, so the id could be used again.
TEST(AfterCrash, OfTwoMotionsOfOneIdTheSecondCounts) {
  StartedMotions two{{started(11, MotionState::failed), started(12, MotionState::running)}};
  for (const std::uint64_t in_journal : {12, 0}) {
    const auto answer = answer_to_repeat(request_of("align-17", in_journal), two);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->id, 12u);
    EXPECT_EQ(answer->state, MotionState::unknown);
  }
  two.kept.pop_back();
  EXPECT_FALSE(answer_to_repeat(request_of("align-17", 12), two)) << "it was not sent";
}

// The motion's journal row was never committed, but the caller may have received an answer.
TEST(AfterCrash, ANumberThatOnlyTheRecordHasIsAnswered) {
  const auto answer = answer_to_repeat(request_of("align-17", 0), StartedMotions{{started(12, MotionState::running)}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->id, 12u);
  EXPECT_EQ(answer->who, "unix anna");
}

// The record keeps only the newest motions. A request that has no motion number, because no journal was kept, may be
// any of the dropped ones.
TEST(AfterCrash, WhatTheRecordHasDroppedIsNotDoneAgain) {
  const StartedMotions dropped{{started(30, MotionState::succeeded, "align-30")}, 12};
  EXPECT_TRUE(answer_to_repeat(request_of("align-17", 12), dropped));
  EXPECT_FALSE(answer_to_repeat(request_of("align-17", 13), dropped));
  EXPECT_TRUE(answer_to_repeat(request_of("align-17", 0), dropped));
}

// A refused request has its own journal entry if it has a request id.
TEST(AfterCrash, AMotionThatWasNotSentIsMarkedAsRefusedIfItsRequestIs) {
  const link_test::TemporaryDirectory directory;
  const std::string path = directory / "journal.sqlite";
  const auto requested = [](std::uint64_t motion, std::string body) {
    return journal::Record{
        {.kind = journal::EntryKind::motion_requested, .device = "stage", .motion = motion, .body = std::move(body)}};
  };
  ASSERT_TRUE(journal::Store::open(path)->append(
      std::vector<journal::Record>{{{.kind = journal::EntryKind::daemon_started, .body = "{}"}},
                                   requested(1, R"({"kind":"move","request_id":"night-17"})"),
                                   requested(2, R"({"kind":"move"})")}));
  {
    const auto journal = *journal::Journal::open(path);
    journal::RequestMemory requests({}, "epoch", Duration::zero());
    EventBus bus([](std::function<void()>) {});
    settle_what_was_left(journal.get(), requests, bus, [](std::string_view) { return StartedMotions(); });
  }
  const std::vector<journal::StoredEntry> kept = *journal::Store::open_to_read(path)->read({}, 10);
  ASSERT_EQ(kept.size(), 5u);
  EXPECT_EQ(kept[1].entry.body,
            R"({"kind":"move","outcome":"FAILED","reason":"NOT_SENT","refused":true,"request_id":"night-17"})");
  EXPECT_EQ(kept[0].entry.body, R"({"kind":"move","outcome":"FAILED","reason":"NOT_SENT"})");
}

}  // namespace
}  // namespace axisgate::server::after_crash_test
