// The thread that writes the journal, and the entries that a device's events leave in it.
#include "server/journal/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "device/link/clock.h"
#include "server/journal/device_entries.h"
#include "server/journal/request_memory.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::journal {
namespace {

bool comes_true(const std::function<bool()>& wanted) {
  const TimePoint limit = monotonic_now() + link_test::kPatience;
  while (!wanted()) {
    if (monotonic_now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // between two checks; the limit above decides
  }
  return true;
}

class JournalTest : public testing::Test {
 protected:
  std::vector<StoredEntry> kept() { return *Store::open_to_read(path_)->read({}, 100'000); }
  void run(const char* sql) { ASSERT_TRUE(Database::open(path_, Database::Access::write)->run(sql)) << sql; }

  const link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "journal.sqlite";
};

TEST_F(JournalTest, WhatIsAppendedByManyThreadsIsOnTheDiskAtItsEnd) {
  constexpr int kThreads = 4;
  constexpr std::uint64_t kEach = 500;
  {
    const auto journal = *Journal::open(path_);
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kThreads; ++thread) {
      threads.emplace_back([&] {
        for (std::uint64_t i = 1; i <= kEach; ++i) {
          journal->append({{.kind = EntryKind::motion_started, .device = "stage", .motion = i}});
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_EQ(kept().size(), kThreads * kEach);
  EXPECT_EQ(Store::open_to_read(path_)->verify({})->first_bad, std::nullopt);
}

TEST_F(JournalTest, H45_ARefusingDiskIsReportedAndTriedAgain) {
  const auto journal = *Journal::open(path_);
  run("ALTER TABLE entry RENAME TO away");
  journal->append({{.kind = EntryKind::stop_requested, .device = "stage"}});
  EXPECT_TRUE(comes_true([&] { return journal->failure().has_value(); }));
  EXPECT_THAT(journal->failure()->message, testing::HasSubstr(path_));
  run("ALTER TABLE away RENAME TO entry");
  EXPECT_TRUE(comes_true([&] { return !journal->failure(); }));
  ASSERT_EQ(kept().size(), 2u);
  EXPECT_EQ(kept()[1].entry.kind, EntryKind::stop_requested);
  EXPECT_EQ(kept()[0].entry.kind, EntryKind::journal_failed);
}

// Further commits arrive while the first refusal is being handled.
TEST_F(JournalTest, H45_ACommitAsTheDiskBeginsToRefuseIsAnswered) {
  for (int round = 0; round < 30; ++round) {
    const auto journal = *Journal::open(path_);
    run("ALTER TABLE entry RENAME TO away");
    std::atomic<int> refused = 0;
    int asked = 0;
    journal->append({{.kind = EntryKind::stop_requested}});
    for (; !journal->failure(); ++asked) {
      journal->commit({{.kind = EntryKind::request_made}}, [&](const Result<void>& done) { refused += done ? 0 : 1; });
    }
    ASSERT_TRUE(comes_true([&] { return refused == asked; })) << refused << " of " << asked << ", round " << round;
    run("ALTER TABLE away RENAME TO entry");
  }
}

TEST_F(JournalTest, WhatWasLeftOutIsCounted) {
  const auto journal = *Journal::open(path_);
  run("ALTER TABLE entry RENAME TO away");
  journal->append({{.kind = EntryKind::stop_requested}});
  ASSERT_TRUE(comes_true([&] { return journal->failure().has_value(); }));
  for (std::size_t i = 0; i < Journal::kWaitingMax + 7; ++i) journal->append({{.kind = EntryKind::stop_requested}});
  run("ALTER TABLE away RENAME TO entry");
  ASSERT_TRUE(comes_true([&] { return kept().size() == Journal::kWaitingMax + 3; }));
  EXPECT_EQ(kept()[0].entry.kind, EntryKind::entries_left_out);
  EXPECT_EQ(kept()[0].entry.body, R"({"count":7})");
}

TEST_F(JournalTest, RefusalsBeyondTheirBudgetAreCountedAtTheEndAtTheLatest) {
  {
    const auto journal = *Journal::open(path_);
    for (int i = 0; i < 70; ++i) {
      journal->append_refusal({.kind = EntryKind::request_refused, .who = "unix anna", .body = "{}"});
    }
    EXPECT_EQ(journal->read({}, 100)->size(), 60u);
  }
  ASSERT_EQ(kept().size(), 61u);
  EXPECT_EQ(kept()[0].entry.body, R"({"count":10})");
  EXPECT_EQ(kept()[0].entry.who, "unix anna");
}

TEST_F(JournalTest, WhereNoFileCanBeMadeTheMessageSaysWhichAndWhy) {
  const std::string path = directory_ / "missing/journal.sqlite";
  const auto opened = Journal::open(path);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message, path + ": unable to open database file: No such file or directory");
}

TEST_F(JournalTest, OneThatCouldNotBeOpenedRefusesAsADiskDoes) {
  std::filesystem::create_symlink(directory_ / "elsewhere", path_);
  const auto opened = Journal::open(path_);
  ASSERT_FALSE(opened);
  const auto journal = Journal::unopened(path_, opened.error());
  EXPECT_FALSE(journal->is_open());
  Result<void> committed;
  journal->commit({{.kind = EntryKind::request_made}}, [&](const Result<void>& done) { committed = done; });
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().reason, Reason::journal_unavailable);
  EXPECT_EQ(committed.error().message,
            "the journal could not be opened: " + path_ + " is a symbolic link, not a regular file");
  EXPECT_EQ(committed.error().hint,
            "nothing was sent; stops work; move it away: the daemon makes this file itself; then restart the daemon");
  for (std::size_t i = 0; i < Journal::kWaitingMax + 7; ++i) journal->append({{.kind = EntryKind::stop_requested}});
  journal->append_refusal({.kind = EntryKind::request_refused, .who = "unix anna", .body = "{}"});
  EXPECT_EQ(journal->failure()->message, committed.error().message);
  EXPECT_EQ(journal->read({}, 1).error().reason, Reason::journal_unavailable);
  EXPECT_EQ(journal->summarize({}).error().reason, Reason::journal_unavailable);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "elsewhere"));
}

TEST_F(JournalTest, ADamagedFileIsMovedAsideAndANewOneBegins) {
  std::ofstream(path_) << std::string(8192, 'x');
  const auto journal = Journal::open(path_);
  ASSERT_TRUE(journal) << journal.error().message;
  EXPECT_EQ((*journal)->head()->number, 0);
  int aside = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(path_).parent_path())) {
    aside += file.path().filename().string().starts_with("journal.sqlite.damaged-") ? 1 : 0;
  }
  EXPECT_EQ(aside, 1);
}

TEST_F(JournalTest, ALinkIsNotFollowed) {
  std::ofstream(directory_ / "elsewhere");
  std::filesystem::create_symlink(directory_ / "elsewhere", path_);
  EXPECT_FALSE(Journal::open(path_));
}

class DeviceEntriesTest : public JournalTest {
 protected:
  // Returns the entries that `events` leave, oldest first, each as kind, caller and body.
  std::vector<std::string> left_by(const std::vector<stage::Event>& events) {
    {
      const auto journal = *Journal::open(path_);
      RequestMemory requests({}, "epoch", Duration::zero());
      DeviceEntries entries("stage", journal.get(), requests);
      for (const stage::Event& event : events) entries.on_event(event, TimePoint(std::chrono::seconds(5)));
    }
    std::vector<std::string> texts;
    const std::vector<StoredEntry> all = kept();
    for (const StoredEntry& stored : all) {
      EXPECT_EQ(stored.entry.device, "stage");
      EXPECT_EQ(stored.entry.boot_time, TimePoint(std::chrono::seconds(5)));
      texts.insert(texts.begin(), name(stored.entry.kind) + "|" + stored.entry.who + "|" + stored.entry.body);
    }
    return texts;
  }
};

TEST_F(DeviceEntriesTest, AMotionFromItsRequestToItsOutcome) {
  stage::Motion motion;
  motion.id = 12;
  motion.axes = stage::AxisSet::of(1);
  motion.who = "unix anna";
  motion.request_id = "scan-7";
  std::vector<stage::Event> events{stage::MotionChanged{motion}};
  motion.state = stage::MotionState::running;
  motion.written = true;
  events.emplace_back(stage::MotionChanged{motion});
  motion.state = stage::MotionState::stopping;
  events.emplace_back(stage::MotionChanged{motion});
  motion.state = stage::MotionState::stopped;
  motion.results = {{.axis = 1, .target_pulses = 5000, .command_pulses = 1250}};
  motion.problem = Problem{.reason = Reason::stopped, .message = "unix bert stopped it"};
  events.emplace_back(stage::MotionChanged{motion});
  EXPECT_THAT(left_by(events),
              testing::ElementsAre(
                  R"(motion requested|unix anna|{"axes":[1],"kind":"move","request_id":"scan-7"})",
                  R"(motion started|unix anna|{"axes":[1],"kind":"move","request_id":"scan-7"})",
                  R"(motion ended|unix anna|{"axes":[1],"kind":"move","outcome":"STOPPED","reason":"STOPPED",)"
                  R"("request_id":"scan-7","results":[{"axis":1,"command_pulses":1250,"target_pulses":5000}]})"))
      << "and no name of a person within";
}

TEST_F(DeviceEntriesTest, TheLinesOfAMotionAreInItsStartAndItsEnd) {
  using stage::BytesWritten, stage::ExchangeEnded;
  stage::Motion motion;
  motion.id = 12;
  motion.axes = stage::AxisSet::of(1);
  motion.created = TimePoint(std::chrono::milliseconds(4998));
  motion.written = true;
  std::vector<stage::Event> events{stage::MotionChanged{motion}};
  events.emplace_back(BytesWritten{.bytes = "A:1+P20000\r\n", .exchange = 1, .who = {}, .motion = 12});
  events.emplace_back(ExchangeEnded{.command = {}, .line = "A:1+P20000", .reply = "O\xFF", .exchange = 1, .who = {}});
  motion.state = stage::MotionState::running;
  events.emplace_back(stage::MotionChanged{motion});
  events.emplace_back(BytesWritten{.bytes = "G:1\r\n", .exchange = 2, .who = {}, .motion = 12});
  motion.state = stage::MotionState::unknown;
  events.emplace_back(stage::MotionChanged{motion});
  EXPECT_THAT(left_by(events),
              testing::ElementsAre(R"(motion requested||{"axes":[1],"kind":"move"})",
                                   "motion started||{\"axes\":[1],\"kind\":\"move\",\"lines\":[[\"A:1+P20000\","
                                   "\"O\xEF\xBF\xBD\",2000]]}",
                                   R"(motion ended||{"axes":[1],"kind":"move","lines":[["G:1",null,2000]],)"
                                   R"("outcome":"UNKNOWN","results":[]})"));
}

TEST_F(DeviceEntriesTest, ALineOfNoMotionHasAnEntryWithItsAxes) {
  EXPECT_THAT(left_by({stage::BytesWritten{.bytes = "L:2\r\n",
                                           .exchange = 1,
                                           .who = "unix bert",
                                           .lane = Lane::stop,
                                           .axes = stage::AxisSet::of(2)},
                       stage::ExchangeEnded{.command = {}, .line = "L:2", .reply = "OK", .exchange = 1, .who = {}}}),
              testing::ElementsAre(R"(lines exchanged|unix bert|{"axes":[2],"lines":[["L:2","OK"]]})"));
}

TEST_F(DeviceEntriesTest, AMotionThatWasRefusedBeforeItsFirstLineSaysSo) {
  stage::Motion motion;
  motion.state = stage::MotionState::failed;
  motion.problem = Problem{.reason = Reason::lease_lost};
  stage::Motion settings = motion, broken = motion;
  settings.kind = broken.kind = stage::MotionKind::execute;
  broken.problem->reason = Reason::line_fault;
  EXPECT_THAT(left_by({stage::MotionChanged{motion}, stage::MotionChanged{settings}, stage::MotionChanged{broken}}),
              testing::ElementsAre(R"(motion ended||{"axes":[],"kind":"move","outcome":"FAILED",)"
                                   R"("reason":"LEASE_LOST","refused":true,"results":[]})",
                                   R"(motion ended||{"axes":[],"kind":"execute","outcome":"FAILED",)"
                                   R"("reason":"LEASE_LOST","refused":true,"results":[]})",
                                   R"(motion ended||{"axes":[],"kind":"execute","outcome":"FAILED",)"
                                   R"("reason":"LINE_FAULT","results":[]})"));
}

TEST_F(DeviceEntriesTest, StopsTheLinkAndWhatNobodyAskedFor) {
  EXPECT_THAT(left_by({stage::StopRequested{stage::AxisSet::of(2), true, "unix bert"},
                       stage::LinkChanged{stage::LinkState::up, "", stage::AxisSet::first(3), "2106001001"},
                       stage::BarrierEntered{"no reply"}, stage::ForeignMotion{stage::AxisSet::of(3)},
                       stage::SwitchesChanged{"unix anna", {{1, 2, "0", "1"}}, false}}),
              testing::ElementsAre(R"(stop requested|unix bert|{"axes":[2],"emergency":true})",
                                   R"(link changed||{"link":"UP","serial_number":"2106001001","why":""})",
                                   R"(barrier entered||{"why":"no reply"})", R"(foreign motion||{"axes":[3]})",
                                   R"(switches changed|unix anna|{"changes":[{"after":"1","before":"0","item":1,)"
                                   R"("number":2}],"unknown":false})"));
}

TEST_F(DeviceEntriesTest, ConditionsHaveTheTimesOfTheirReadings) {
  const TimePoint seen = monotonic_now(), before = seen - std::chrono::seconds(1);
  const auto entries = left_by(
      {stage::ConditionChanged{
           .condition = stage::Condition::cw_limit, .axes = stage::AxisSet::of(2), .before = before, .seen = seen},
       stage::ConditionChanged{.condition = stage::Condition::mode, .begun = false, .value = "HOST", .seen = seen}});
  EXPECT_THAT(entries,
              testing::ElementsAre(
                  testing::MatchesRegex(R"(condition changed\|\|\{"axes":\[2\],"before_us":[0-9]+,"begun":true,)"
                                        R"("condition":"cw_limit","seen_us":[0-9]+\})"),
                  testing::MatchesRegex(R"(condition changed\|\|\{"axes":\[\],"begun":false,)"
                                        R"("condition":"mode","seen_us":[0-9]+,"value":"HOST"\})")));
}

TEST_F(DeviceEntriesTest, WhatPassesEachMomentIsLeftToTheRecording) {
  EXPECT_THAT(left_by({stage::StateChanged{}, stage::ProgramNotice{}, stage::CompletionSeen{1, 1}}),
              testing::IsEmpty());
}

TEST_F(DeviceEntriesTest, BytesOfADeviceThatAreNoTextStayReadable) {
  EXPECT_THAT(left_by({stage::BarrierEntered{"garbled: \xFF"}}),
              testing::ElementsAre("barrier entered||{\"why\":\"garbled: \xEF\xBF\xBD\"}"));
}

}  // namespace
}  // namespace axisgate::server::journal
