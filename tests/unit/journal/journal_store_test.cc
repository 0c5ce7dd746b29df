// The journal's file: appended entries are found again, and changes to them are detected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "server/journal/store.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::journal {
namespace {

using std::chrono::hours;
using testing::HasSubstr;

const WallTime kNight = std::chrono::sys_days(std::chrono::year(2026) / 11 / 24) + hours(1);

Entry moved(std::uint64_t motion, std::string who, WallTime time) {
  return {.kind = EntryKind::motion_ended,
          .time = time,
          .boot_time = TimePoint(std::chrono::seconds(motion)),
          .device = "stage",
          .who = std::move(who),
          .motion = motion,
          .body = R"({"outcome":"SUCCEEDED"})"};
}

class JournalStoreTest : public testing::Test {
 protected:
  JournalStoreTest() {
    const std::array<Record, 3> night{{{moved(1, "unix anna", kNight)},
                                       {moved(2, "unix bert", kNight + hours(1))},
                                       {moved(3, "unix anna", kNight + hours(2))}}};
    Store store = *Store::open(path_);
    EXPECT_TRUE(store.append(night));
  }

  std::vector<std::uint64_t> found(const Filter& filter, std::size_t limit = 100) {
    std::vector<std::uint64_t> motions;
    const std::vector<StoredEntry> all = *Store::open(path_)->read(filter, limit);
    for (const StoredEntry& stored : all) motions.push_back(stored.entry.motion);
    return motions;
  }
  void tamper(const char* sql) { ASSERT_TRUE(Database::open(path_, Database::Access::write)->run(sql)) << sql; }
  Verdict verdict(const std::optional<Head>& noted = {}) { return *Store::open_to_read(path_)->verify(noted); }

  const link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "journal.sqlite";
};

TEST_F(JournalStoreTest, WhatWasAppendedIsReadNewestFirst) {
  const auto all = *Store::open(path_)->read({}, 100);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].number, 3);
  const Entry& newest = all[0].entry;
  EXPECT_EQ(newest.kind, EntryKind::motion_ended);
  EXPECT_EQ(newest.time, kNight + hours(2));
  EXPECT_EQ(newest.boot_time, TimePoint(std::chrono::seconds(3)));
  EXPECT_EQ(newest.device, "stage");
  EXPECT_EQ(newest.who, "unix anna");
  EXPECT_EQ(newest.motion, 3u);
  EXPECT_EQ(newest.body, R"({"outcome":"SUCCEEDED"})");
}

TEST_F(JournalStoreTest, EachFilterCounts) {
  using testing::ElementsAre;
  EXPECT_THAT(found({.from = kNight + hours(1)}), ElementsAre(3, 2));
  EXPECT_THAT(found({.to = kNight + hours(1)}), ElementsAre(1)) << "not at the end itself";
  EXPECT_THAT(found({.who = "unix anna"}), ElementsAre(3, 1));
  EXPECT_THAT(found({.who = "unix carl"}), ElementsAre());
  EXPECT_THAT(found({.device = "mill"}), ElementsAre());
  EXPECT_THAT(found({.motion = 2}), ElementsAre(2));
  EXPECT_THAT(found({.kinds = {EntryKind::stop_requested}}), ElementsAre());
  EXPECT_THAT(found({.before = 3}, 1), ElementsAre(2)) << "a page of one";
}

TEST_F(JournalStoreTest, OneIdentityIsReadWithWhatIsNobodys) {
  using testing::ElementsAre;
  ASSERT_TRUE(Store::open(path_)->append(std::vector<Record>{{moved(4, "", kNight)},
                                                             {moved(5, "tcp 127.0.0.1:39482", kNight)},
                                                             {moved(6, "tcp [::1]:39483", kNight)},
                                                             {moved(7, "unix anna2", kNight)}}));
  EXPECT_THAT(found({.identity = "unix anna"}), ElementsAre(4, 3, 1));
  EXPECT_THAT(found({.identity = "unix anna"}, 2), ElementsAre(4, 3)) << "a page is full";
  EXPECT_THAT(found({.who = "unix bert", .identity = "unix anna"}), ElementsAre());
  EXPECT_THAT(found({.identity = "tcp"}), ElementsAre(6, 5, 4)) << "all anonymous callers are one";
  EXPECT_THAT(found({.identity = "unix carl"}), ElementsAre(4));
}

TEST_F(JournalStoreTest, OldestFirstIsTheOtherOrder) {
  using testing::ElementsAre;
  EXPECT_THAT(found({.oldest_first = true}), ElementsAre(1, 2, 3));
  EXPECT_THAT(found({.after = 1, .oldest_first = true}, 1), ElementsAre(2)) << "a page of one";
  EXPECT_THAT(found({.after = 3}), ElementsAre());
}

TEST_F(JournalStoreTest, WhatABodySaysIsFound) {
  using testing::ElementsAre;
  Entry failed = moved(4, "unix anna", kNight);
  failed.body = R"({"axes":[2,3],"outcome":"FAILED","reason":"LIMIT_DETECTED"})";
  Entry started = moved(5, "unix anna", kNight);
  started.kind = EntryKind::motion_started;
  started.body = R"({"axes":[2],"outcome":"FAILED"})";
  Entry odd = moved(6, "unix anna", kNight);
  odd.body = "no JSON: axes 2";
  ASSERT_TRUE(Store::open(path_)->append(std::vector<Record>{{failed}, {started}, {odd}}));
  EXPECT_THAT(found({.axis = 2}), ElementsAre(5, 4));
  EXPECT_THAT(found({.axis = 3}), ElementsAre(4));
  EXPECT_THAT(found({.axis = 1}), ElementsAre());
  EXPECT_THAT(found({.outcome = "FAILED"}), ElementsAre(4)) << "of an end alone";
  EXPECT_THAT(found({.kinds = {EntryKind::motion_started}, .outcome = "FAILED"}), ElementsAre());
  EXPECT_THAT(found({.text = "LIMIT_"}), ElementsAre(4));
  EXPECT_THAT(found({.text = "limit_"}), ElementsAre());
  EXPECT_THAT(found({.text = "axes 2"}), ElementsAre(6));
  EXPECT_THAT(found({.text = "%"}), ElementsAre()) << "no pattern";
}

TEST_F(JournalStoreTest, MotionsAreNumberedOverRestarts) {
  EXPECT_EQ(*Store::open(path_)->last_motion("stage"), 3u);
  EXPECT_EQ(*Store::open(path_)->last_motion("mill"), 0u);
}

TEST_F(JournalStoreTest, AWholeChainIsGood) {
  EXPECT_EQ(verdict().rows, 3);
  EXPECT_FALSE(verdict().first_bad);
  EXPECT_EQ(verdict().fault, "");
}

// Without the newest row the index gives a wrong number for the last motion.
TEST_F(JournalStoreTest, AnIndexThatLacksARowIsFoundBesideAGoodChain) {
  tamper(
      "PRAGMA writable_schema = ON; "
      "UPDATE sqlite_schema SET sql = sql || ' WHERE number < 3' WHERE name = 'entry_by_motion'; "
      "PRAGMA writable_schema = RESET; REINDEX entry_by_motion; PRAGMA writable_schema = ON; "
      "UPDATE sqlite_schema SET sql = replace(sql, ' WHERE number < 3', '') WHERE name = 'entry_by_motion'");
  EXPECT_EQ(*Store::open(path_)->last_motion("stage"), 2u);
  EXPECT_EQ(verdict().rows, 3);
  EXPECT_FALSE(verdict().first_bad);
  EXPECT_EQ(verdict().fault, "row 3 missing from index entry_by_motion");
}

struct Tampering {
  std::string_view name;
  const char* sql;
  std::int64_t first_bad;
};
void PrintTo(const Tampering& one, std::ostream* out) { *out << one.name; }

class JournalTampering : public JournalStoreTest, public testing::WithParamInterface<Tampering> {};

TEST_P(JournalTampering, IsFoundAtItsFirstRow) {
  tamper(GetParam().sql);
  EXPECT_EQ(verdict().first_bad, GetParam().first_bad) << verdict().fault;
}

INSTANTIATE_TEST_SUITE_P(
    Rows, JournalTampering,
    testing::Values(Tampering{"kind", "UPDATE entry SET kind = 20 WHERE number = 2", 2},
                    Tampering{"time", "UPDATE entry SET time_us = time_us + 1 WHERE number = 2", 2},
                    Tampering{"boot_time", "UPDATE entry SET boot_time_us = 0 WHERE number = 2", 2},
                    Tampering{"device", "UPDATE entry SET device = 'mill' WHERE number = 2", 2},
                    Tampering{"person", "UPDATE entry SET person = 1 WHERE number = 2", 2},
                    Tampering{"motion", "UPDATE entry SET motion = 9 WHERE number = 2", 2},
                    Tampering{"body", "UPDATE entry SET body = '{}' WHERE number = 2", 2},
                    Tampering{"hash", "UPDATE entry SET hash = x'00' WHERE number = 2", 2},
                    Tampering{"first_removed", "DELETE FROM entry WHERE number = 1", 1},
                    Tampering{"one_removed", "DELETE FROM entry WHERE number = 2", 2},
                    Tampering{"one_added",
                              "INSERT INTO entry SELECT 4, time_us, boot_time_us, kind, device, person, motion, body, "
                              "hash FROM entry WHERE number = 3",
                              4},
                    Tampering{"two_exchanged",
                              "UPDATE entry SET number = -1 WHERE number = 1; UPDATE entry SET number = 1 WHERE "
                              "number = 2; UPDATE entry SET number = 2 WHERE number = -1",
                              1}),
    [](const auto& one) { return std::string(one.param.name); });

// Anyone who can write the file can also compute all hashes again.
TEST_F(JournalStoreTest, WhoComputesAllHashesIsFoundOutByAHeadThatWasNoted) {
  const Head noted = *Store::open_to_read(path_)->head();
  const auto rows = *Store::open_to_read(path_)->read({}, 100);
  tamper("DELETE FROM entry");
  std::vector<Record> forged;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) forged.push_back({row->entry});
  forged[1].entry.body = R"({"outcome":"FAILED"})";
  ASSERT_TRUE(Store::open(path_)->append(forged));
  EXPECT_FALSE(verdict().first_bad) << "the chain alone shows nothing";
  EXPECT_EQ(verdict(noted).first_bad, 3) << verdict(noted).fault;
  tamper("DELETE FROM entry WHERE number = 3");
  EXPECT_EQ(verdict(noted).first_bad, 3) << verdict(noted).fault;
}

// A file of three segments and a few rows more; the rows of the first segment are a year older.
class DroppedSegmentsTest : public JournalStoreTest {
 protected:
  DroppedSegmentsTest() {
    Store store = *Store::open(path_);
    std::vector<Record> rows;
    for (std::int64_t i = 4; i <= 3 * Store::kSegment + 10; ++i) {
      const auto time = i <= Store::kSegment ? kNight : kNight + hours(24 * 365);
      rows.push_back({moved(static_cast<std::uint64_t>(i), "unix anna", time)});
    }
    EXPECT_TRUE(store.append(rows));
  }
  bool drop(const StoreBounds& bounds) {
    return Store::open(path_)->drop_old(bounds, moved(0, "", kNight + hours(24 * 365))).value();
  }
};

TEST_F(DroppedSegmentsTest, WhatIsTooOldIsDroppedInWholeSegments) {
  const StoreBounds month{.age = hours(24 * 30)};
  EXPECT_TRUE(drop(month));
  EXPECT_FALSE(drop(month)) << "the next segment is not too old";
  EXPECT_FALSE(verdict().first_bad) << verdict().fault;
  EXPECT_EQ(verdict().rows, 2 * Store::kSegment + 11) << "with the entry that says so";
}

TEST_F(DroppedSegmentsTest, OfAFileThatIsTooLargeTheNewestSegmentStays) {
  const StoreBounds small{.bytes = 1};
  EXPECT_TRUE(drop(small));
  EXPECT_TRUE(drop(small));
  EXPECT_FALSE(drop(small));
  EXPECT_FALSE(verdict().first_bad) << verdict().fault;
}

TEST_F(DroppedSegmentsTest, ABeginningThatNobodyDroppedIsFound) {
  EXPECT_TRUE(drop({.bytes = 1}));
  tamper("DELETE FROM entry WHERE number = 10001");
  EXPECT_EQ(verdict().first_bad, 10'001) << verdict().fault;
  tamper(
      "UPDATE meta SET value = '10001 ' || (SELECT lower(hex(hash)) FROM entry WHERE number = 10002) WHERE key = "
      "'dropped'");
  EXPECT_TRUE(verdict().first_bad) << "who moves the beginning is found out by the entry that says where it is";
}

TEST_F(DroppedSegmentsTest, AHeadFromBeforeShowsNothing) {
  const Head noted{Store::open_to_read(path_)->epoch().value(), 3, {}};
  EXPECT_TRUE(drop({.bytes = 1}));
  EXPECT_EQ(verdict(noted).first_bad, 3) << verdict(noted).fault;
}

TEST_F(JournalStoreTest, AHeadOfAnotherFileIsNoneOfThisChain) {
  Head noted = *Store::open_to_read(path_)->head();
  noted.epoch = "0123";
  EXPECT_EQ(verdict(noted).first_bad, 1);
}

// A person's name can be erased, because the chain contains only a number.
TEST_F(JournalStoreTest, ErasingANameLeavesTheChain) {
  tamper("UPDATE person SET name = 'erased 1' WHERE name = 'unix anna'");
  EXPECT_FALSE(verdict().first_bad);
  EXPECT_THAT(found({.who = "unix anna"}), testing::IsEmpty());
}

TEST_F(JournalStoreTest, AnEntryThatIsNoTextIsKeptAsItIs) {
  Entry odd = moved(4, "unix anna", kNight);
  odd.device = std::string("a\0b", 3);
  ASSERT_TRUE(Store::open(path_)->append(std::array{Record{odd}}));
  const std::vector<StoredEntry> newest = *Store::open(path_)->read({}, 1);
  EXPECT_EQ(newest.at(0).entry.device, odd.device);
  EXPECT_FALSE(verdict().first_bad);
}

TEST_F(JournalStoreTest, AFileOfANewerVersionIsRefusedWithWhatToDo) {
  tamper("PRAGMA user_version = 7");
  const auto opened = Store::open(path_);
  ASSERT_FALSE(opened);
  EXPECT_FALSE(opened.error().damaged);
  EXPECT_THAT(opened.error().problem.message, HasSubstr("a newer version of axisgated has written it (schema 7"));
  EXPECT_THAT(opened.error().problem.hint, HasSubstr("install that version again"));
}

TEST_F(JournalStoreTest, AFileThatIsNoJournalIsDamaged) {
  std::ofstream(path_, std::ios::trunc) << std::string(8192, 'x');
  std::filesystem::remove(path_ + "-wal");
  const auto opened = Store::open(path_);
  ASSERT_FALSE(opened);
  EXPECT_TRUE(opened.error().damaged);
}

}  // namespace
}  // namespace axisgate::server::journal
