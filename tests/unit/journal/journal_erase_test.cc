// Erasure of a name from all files of the journal, which leaves the chain of entries unchanged.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "device/link/clock.h"
#include "server/journal/journal.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::journal_erase_test {
namespace {

using journal::Database;
using journal::Entry;
using journal::EntryKind;
using journal::Filter;
using journal::Head;
using journal::Journal;
using journal::Record;
using journal::Store;
using journal::StoredEntry;
using testing::HasSubstr;

class JournalErase : public testing::Test {
 protected:
  void open() { journal_ = *Journal::open(path_); }
  Database database() const { return *Database::open(path_, Database::Access::write); }
  void run(const std::string& sql) const { ASSERT_TRUE(database().run(sql.c_str())) << sql; }

  // Appends an entry and waits until it is on the disk.
  void append(std::string who) {
    journal_->append(
        {Entry{.kind = EntryKind::stop_requested, .device = "stage", .who = std::move(who), .body = "{}"}});
    (void)journal_->head();
  }
  std::vector<StoredEntry> entries() const { return *journal_->read(Filter(), 100); }
  // Returns the bytes of all files in the journal's directory.
  std::string bytes() const {
    std::string all;
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(path_).parent_path())) {
      std::ifstream content(file.path(), std::ios::binary);
      all.append(std::istreambuf_iterator<char>(content), {});
    }
    return all;
  }
  bool comes_true(const std::function<bool()>& wanted) const {
    const TimePoint limit = monotonic_now() + link_test::kPatience;
    while (!wanted()) {
      if (monotonic_now() > limit) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // between two checks; the limit above decides
    }
    return true;
  }

  const link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "journal.sqlite";
  std::unique_ptr<Journal> journal_;
};

// Acts like an SQLite built without the option SECURE_DELETE, which sets the default for connections. Debian's build
// has it.
class WithoutSecureDelete {
 public:
  WithoutSecureDelete() { sqlite3_auto_extension(hook()); }
  ~WithoutSecureDelete() { sqlite3_cancel_auto_extension(hook()); }
  WithoutSecureDelete(const WithoutSecureDelete&) = delete;
  WithoutSecureDelete& operator=(const WithoutSecureDelete&) = delete;

 private:
  static int switch_off(sqlite3* database, char**, const sqlite3_api_routines*) {
    return sqlite3_exec(database, "PRAGMA secure_delete = OFF", nullptr, nullptr, nullptr);
  }
  static void (*hook())() { return reinterpret_cast<void (*)()>(&switch_off); }
};

// A daemon without secure_delete has left the file with copies of names in freed bytes.
TEST_F(JournalErase, NoFileHasTheNameAnyMore) {
  const WithoutSecureDelete sqlite;
  std::mt19937 random(7);
  std::vector<std::string> names;
  for (int i = 0; i < 300; ++i) names.push_back(fmt::format("unix u{:08x}", random()));
  ASSERT_TRUE(Store::open(path_));
  Database old = database();
  ASSERT_TRUE(old.run("PRAGMA secure_delete = OFF"));
  for (const std::string& name : names) {
    ASSERT_TRUE(old.run(fmt::format("INSERT INTO person(name) VALUES('{}')", name).c_str()));
  }
  open();
  for (std::size_t i = 0; i < names.size(); i += 10) {
    append(names[i]);
    ASSERT_THAT(bytes(), HasSubstr(names[i]));
    const auto erased = journal_->erase(names[i], "unix root");
    ASSERT_TRUE(erased && *erased);
    EXPECT_EQ((*erased)->entries, 1);
    EXPECT_THAT(bytes().find(names[i]), std::string::npos) << names[i];
  }
  EXPECT_THAT(bytes(), HasSubstr(names[1])) << "and the other names stay";
}

TEST_F(JournalErase, TheChainIsAsItWasAndAnEntrySaysWhoErasedWhom) {
  open();
  append("unix anna");
  append("unix bert");
  const Head noted = *journal_->head();
  ASSERT_TRUE(journal_->erase("unix anna", "unix root"));
  EXPECT_EQ(journal_->verify(noted)->first_bad, std::nullopt);
  const std::vector<StoredEntry> all = entries();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[2].entry.who, "erased 1");
  EXPECT_EQ(all[1].entry.who, "unix bert");
  EXPECT_EQ(all[0].entry.kind, EntryKind::person_erased);
  EXPECT_EQ(all[0].entry.who, "unix root");
  EXPECT_EQ(all[0].entry.body, R"({"person":1})");
}

TEST_F(JournalErase, WhoIsNotThereIsNotErased) {
  open();
  append("unix anna");
  ASSERT_TRUE(*journal_->erase("unix anna", "unix root"));
  for (const char* name : {"unix anna", "unix", "erased 1", ""}) {
    const auto erased = journal_->erase(name, "unix root");
    ASSERT_TRUE(erased) << erased.error().message;
    EXPECT_FALSE(*erased) << name;
  }
  EXPECT_EQ(entries().size(), 2u);
}

TEST_F(JournalErase, WhoCallsAgainIsAnotherCaller) {
  open();
  append("unix anna");
  ASSERT_TRUE(*journal_->erase("unix anna", "unix root"));
  append("unix anna");
  EXPECT_EQ(entries()[0].entry.who, "unix anna");
  EXPECT_EQ(entries()[2].entry.who, "erased 1");
  const auto again = journal_->erase("unix anna", "unix root");
  ASSERT_TRUE(again && *again);
  EXPECT_NE((*again)->number, 1);
  EXPECT_EQ((*again)->entries, 1);
}

TEST_F(JournalErase, AnAdministratorMayEraseTheirOwnName) {
  open();
  append("unix root");
  ASSERT_TRUE(*journal_->erase("unix root", "unix root"));
  EXPECT_EQ(entries()[0].entry.who, "erased 1");
  EXPECT_EQ(bytes().find("unix root"), std::string::npos);
}

TEST_F(JournalErase, RememberedRequestsWithTheNameAreCounted) {
  ASSERT_TRUE(Store::open(path_)->append(std::vector<Record>{
      {{.who = "unix anna"}, {.request = {.identity = "unix anna", .id = "a", .number = 1}}},
      {{.who = "unix bert"},
       {.request = {.identity = "unix bert", .id = "b", .number = 2, .answer = "unix anna stopped it"}}},
      {{.who = "unix bert"}, {.request = {.identity = "unix bert", .id = "c", .number = 3}}}}));
  open();
  EXPECT_EQ((*journal_->erase("unix anna", "unix root"))->requests, 2);
}

journal::FactChange fact_about_anna() {
  stage::MotionChanged change;
  change.motion.who = "unix anna";
  change.motion.problem = Problem{.reason = Reason::stopped, .message = "stopped by unix anna"};
  return {{std::make_shared<const FactRecord>(FactRecord{1, "stage", {}, change, {}, "r"})}, 1};
}

TEST_F(JournalErase, KeptEventsHaveTheNameNoMore) {
  const Record record{{.who = "unix anna"}};
  ASSERT_TRUE(Store::open(path_)->append({&record, 1}, fact_about_anna()));
  open();
  ASSERT_TRUE(*journal_->erase("unix anna", "unix root"));
  EXPECT_EQ(bytes().find("unix anna"), std::string::npos);
  const auto kept = Store::open(path_)->begin_facts(false);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->facts.size(), 1u);
  EXPECT_EQ(std::get<stage::MotionChanged>(kept->facts[0]->fact).motion.who, "erased 1");
}

TEST_F(JournalErase, EventsThatAreWrittenWithTheErasureHaveTheNameNoMore) {
  auto store = Store::open(path_);
  const Record before{{.who = "unix anna"}};
  ASSERT_TRUE(store->append({&before, 1}, {}));
  const Record erasure{{.kind = EntryKind::person_erased, .who = "unix root", .body = "{}"}, {}, 1};
  ASSERT_TRUE(store->append({&erasure, 1}, fact_about_anna()));
  ASSERT_TRUE(store->empty_log());
  EXPECT_EQ(bytes().find("unix anna"), std::string::npos);
}

TEST_F(JournalErase, WhileAnotherProgramReadsTheLogKeepsTheName) {
  open();
  append("unix anna");
  {
    Database other = database();
    ASSERT_TRUE(other.run("BEGIN; SELECT * FROM entry"));
    const auto erased = journal_->erase("unix anna", "unix root");
    ASSERT_FALSE(erased);
    EXPECT_EQ(erased.error().reason, Reason::journal_unavailable);
    EXPECT_THAT(erased.error().message, HasSubstr("the name is erased, but it stays in " + path_ + "-wal"));
    EXPECT_EQ(entries()[1].entry.who, "erased 1");
    EXPECT_THAT(bytes(), HasSubstr("unix anna"));
  }
  append("unix bert");
  EXPECT_TRUE(comes_true([this] { return bytes().find("unix anna") == std::string::npos; }));
}

TEST_F(JournalErase, ADiskThatRefusesErasesNothing) {
  open();
  append("unix anna");
  run("CREATE TRIGGER refuse BEFORE INSERT ON entry BEGIN SELECT RAISE(ABORT, 'the disk is full'); END");
  const auto erased = journal_->erase("unix anna", "unix root");
  ASSERT_FALSE(erased);
  EXPECT_EQ(erased.error().reason, Reason::journal_unavailable);
  EXPECT_THAT(erased.error().message, HasSubstr("the disk is full"));
  run("DROP TRIGGER refuse");
  ASSERT_TRUE(comes_true([this] { return !journal_->failure(); }));
  EXPECT_EQ(entries().back().entry.who, "unix anna") << "nor later";
}

}  // namespace
}  // namespace axisgate::server::journal_erase_test
