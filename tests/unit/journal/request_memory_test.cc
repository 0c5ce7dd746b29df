#include "server/journal/request_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "server/journal/journal.h"

namespace axisgate::server::journal {
namespace {

using std::chrono::hours;
using Known = RequestMemory::Known;

constexpr TimePoint kBeginning{hours(8)};
const RequestMemory::Key kKey{"unix anna", "align-17"};

RememberedRequest move_by(std::string identity, std::string id, std::string digest = "1 mm") {
  return {.identity = std::move(identity),
          .id = std::move(id),
          .digest = std::move(digest),
          .device = "stage",
          .moves = true};
}

// Answers to requests whose ids were known.
struct Answers {
  RequestMemory::OnKnown known() {
    return [this](const Result<Known>& one) { all.push_back(one); };
  }
  std::vector<Result<Known>> all;
};

class RequestMemoryTest : public testing::Test {
 protected:
  // Returns true if the request is new and may act; otherwise false, with the reason if it was refused.
  std::pair<bool, Reason> begin(const RememberedRequest& request, std::string_view mark = "",
                                TimePoint now = kBeginning) {
    const auto begun = memory_.begin(request, mark, now, answers_.known());
    if (!begun) return {false, begun.error().reason};
    if (*begun && (*begun)->forgotten > 0) forgotten_ = (*begun)->forgotten;
    return {begun->has_value(), Reason::unspecified};
  }
  bool is_new(const std::string& id, TimePoint now = kBeginning) {
    return begin(move_by("unix anna", id), "", now).first;
  }
  // Runs a request from its arrival to its end.
  void run(const std::string& id, std::uint64_t motion, TimePoint now = kBeginning) {
    const RequestMemory::Key key{"unix anna", id};
    ASSERT_TRUE(is_new(id, now));
    ASSERT_TRUE(memory_.made(key, motion, "queued"));
    memory_.acted(key);
    ASSERT_TRUE(memory_.motion_ended(key, motion, "ended"));
  }

  RequestMemory memory_{{.kept = hours(24), .most = 3}, "first", Duration::zero()};
  Answers answers_;
  std::int64_t forgotten_ = 0;
};

TEST_F(RequestMemoryTest, ARepeatIsAnsweredAndDoesNotAct) {
  run("align-17", 12);
  EXPECT_FALSE(is_new("align-17", kBeginning + hours(23)));
  ASSERT_EQ(answers_.all.size(), 1u);
  EXPECT_EQ(answers_.all[0]->motion, 12u);
  EXPECT_EQ(answers_.all[0]->answer, "ended");
  EXPECT_FALSE(answers_.all[0]->open);
}

TEST_F(RequestMemoryTest, ARepeatThatComesBeforeTheAnswerWaitsForIt) {
  ASSERT_TRUE(is_new("align-17"));
  EXPECT_FALSE(is_new("align-17"));
  ASSERT_TRUE(memory_.made(kKey, 12, "queued"));
  EXPECT_TRUE(answers_.all.empty());
  memory_.acted(kKey);
  ASSERT_EQ(answers_.all.size(), 1u);
  EXPECT_EQ(answers_.all[0]->motion, 12u);
  EXPECT_TRUE(answers_.all[0]->open);
}

TEST_F(RequestMemoryTest, AnotherRequestUnderTheSameIdIsRefused) {
  run("align-17", 12);
  EXPECT_EQ(begin(move_by("unix anna", "align-17", "2 mm")).second, Reason::request_id_reused);
  EXPECT_TRUE(begin(move_by("unix bert", "align-17", "2 mm")).first) << "another caller has ids of its own";
}

TEST_F(RequestMemoryTest, WhatDidNothingLeavesItsIdFree) {
  ASSERT_TRUE(is_new("align-17"));
  EXPECT_FALSE(is_new("align-17"));
  const auto change = memory_.refused(kKey, {.reason = Reason::lease_held});
  ASSERT_TRUE(change);
  EXPECT_TRUE(change->forget);
  ASSERT_EQ(answers_.all.size(), 1u);
  EXPECT_EQ(answers_.all[0].error().reason, Reason::lease_held) << "who waited is refused, too";
  EXPECT_TRUE(is_new("align-17"));
}

TEST_F(RequestMemoryTest, WhatHasEndedIsNotFreeAgain) {
  run("align-17", 12);
  EXPECT_FALSE(memory_.refused(kKey, {.reason = Reason::device_refused}));
  EXPECT_FALSE(is_new("align-17"));
}

TEST_F(RequestMemoryTest, AfterADayAnIdIsForgotten) {
  run("align-17", 12);
  EXPECT_TRUE(is_new("align-17", kBeginning + hours(25)));
  EXPECT_EQ(forgotten_, 1) << "and the file must forget it, too";
}

TEST_F(RequestMemoryTest, OfTooManyTheOldestIsForgotten) {
  for (std::uint64_t i = 1; i <= 5; ++i) run("align-" + std::to_string(i), i);
  EXPECT_FALSE(is_new("align-4"));
  EXPECT_TRUE(is_new("align-1"));
}

TEST_F(RequestMemoryTest, WhatHasNotEndedIsNotForgotten) {
  ASSERT_TRUE(is_new("align-1"));
  for (std::uint64_t i = 2; i <= 6; ++i) run("align-" + std::to_string(i), i);
  EXPECT_FALSE(is_new("align-1", kBeginning + hours(25)));
}

TEST_F(RequestMemoryTest, ARepeatThatMayBeForgottenIsRefused) {
  const std::string mark = memory_.mark();
  run("align-17", 12);
  EXPECT_TRUE(begin(move_by("unix anna", "align-18"), mark).first) << "nothing was forgotten yet";
  ASSERT_TRUE(is_new("align-19", kBeginning + hours(25)));
  EXPECT_EQ(begin(move_by("unix anna", "align-17"), mark, kBeginning + hours(25)).second, Reason::request_memory_lost);
  EXPECT_EQ(begin(move_by("unix anna", "align-17"), "other-7").second, Reason::request_memory_lost);
  EXPECT_EQ(begin(move_by("unix anna", "align-17"), "no mark").second, Reason::request_memory_lost);
  EXPECT_TRUE(begin(move_by("unix anna", "align-20"), memory_.mark(), kBeginning + hours(25)).first);
}

class KeptRequestsTest : public testing::Test {
 protected:
  KeptRequestsTest() { std::filesystem::create_directories(directory_); }
  ~KeptRequestsTest() override { std::filesystem::remove_all(directory_); }

  const std::filesystem::path directory_ =
      std::filesystem::path(testing::TempDir()) / ("axisgate-requests-" + std::to_string(::getpid()));
  const std::string path_ = directory_ / "journal.sqlite";
};

TEST_F(KeptRequestsTest, AreKnownToTheNextRun) {
  std::string mark;
  {
    const auto journal = *Journal::open(path_, "boot-1");
    RequestMemory memory({}, journal->epoch(), journal->boot_offset(), journal->take_requests());
    mark = memory.mark();
    journal->append({{}, **memory.begin(move_by("unix anna", "align-17"), "", kBeginning, {})});
    journal->append({{}, *memory.made(kKey, 12, "queued")});
    journal->append({{}, *memory.motion_ended(kKey, 12, "ended")});
    journal->append({{}, **memory.begin(move_by("unix anna", "align-18"), "", kBeginning, {})});
  }
  const auto journal = *Journal::open(path_, "boot-1");
  RequestMemory memory({}, journal->epoch(), journal->boot_offset(), journal->take_requests());
  Answers answers;
  EXPECT_EQ(*memory.begin(move_by("unix anna", "align-17"), mark, kBeginning, answers.known()), std::nullopt);
  ASSERT_EQ(answers.all.size(), 1u);
  EXPECT_EQ(answers.all[0]->answer, "ended");
  ASSERT_EQ(memory.open().size(), 1u);
  EXPECT_EQ(memory.open()[0].id, "align-18");
}

TEST_F(KeptRequestsTest, ANewFileIsANewMemory) {
  const std::string mark = [&] {
    const auto journal = *Journal::open(path_);
    return RequestMemory({}, journal->epoch(), journal->boot_offset(), journal->take_requests()).mark();
  }();
  std::filesystem::remove(path_);
  const auto journal = *Journal::open(path_);
  RequestMemory memory({}, journal->epoch(), journal->boot_offset(), journal->take_requests());
  const auto begun = memory.begin(move_by("unix anna", "align-17"), mark, kBeginning, {});
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().reason, Reason::request_memory_lost);
}

// A machine that was off for a week has forgotten nothing: its clock did not run.
TEST_F(KeptRequestsTest, TheTimeBetweenTwoBootsDoesNotCount) {
  {
    const auto store = Store::open(path_);
    Store open = *Store::open(path_);
    ASSERT_EQ(*open.boot_offset("boot-1", kBeginning), -kBeginning.time_since_epoch());
    RememberedRequest request = move_by("unix anna", "align-17");
    request.lived = hours(5);
    ASSERT_TRUE(open.append(std::vector{Record{{}, {request, false, 0}}}));
    EXPECT_EQ(*open.boot_offset("boot-1", kBeginning + hours(9)), -kBeginning.time_since_epoch()) << "the same boot";
  }
  EXPECT_EQ(*Store::open(path_)->boot_offset("boot-2", TimePoint(hours(1))), hours(4)) << "5 h lived, 1 h after boot";
}

}  // namespace
}  // namespace axisgate::server::journal
