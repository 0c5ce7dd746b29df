// Facts in the journal's file: after a restart they are the published ones, and no revision is used twice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/link/clock.h"
#include "server/journal/journal.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::journal_facts_test {
namespace {

using journal::Database;
using journal::EntryKind;
using journal::FactTable;
using journal::Journal;
using testing::ElementsAre;
using testing::IsEmpty;

class JournalFactsTest : public testing::Test {
 protected:
  // A run of the daemon: its journal, and the bus that fills the journal.
  struct Run {
    explicit Run(const std::string& path, std::size_t facts_kept = EventBus::kFactsKept)
        : journal(*Journal::open(path)),
          unclean(journal->after_unclean_end()),
          bus([](std::function<void()>) {}, "run " + std::to_string(++runs), journal->take_facts(),
              [this](FactPointer fact, std::uint64_t oldest) { journal->keep(std::move(fact), oldest); }, facts_kept) {
      journal->append({{.kind = EntryKind::daemon_started}});
    }
    void end() { journal->append({{.kind = EntryKind::daemon_ended}}); }
    void publish(int count) {
      for (int i = 0; i < count; ++i)
        bus.publish("stage", stage::CompletionSeen{1, 7}, WallTime(std::chrono::hours(i)));
    }
    std::vector<std::uint64_t> revisions() {
      std::vector<std::uint64_t> found;
      const EventBus::Reading reading = bus.read(0, 100'000);
      for (const auto& fact : reading.facts) found.push_back(fact->revision);
      return found;
    }

    static inline int runs = 0;
    std::unique_ptr<Journal> journal;
    const bool unclean;
    EventBus bus;
  };

  void run_sql(const char* sql) { ASSERT_TRUE(Database::open(path_, Database::Access::write)->run(sql)) << sql; }
  std::int64_t number(const char* sql) {
    auto database = *Database::open(path_, Database::Access::read);
    auto statement = *database.prepare(sql);
    EXPECT_TRUE(*statement.step());
    return statement.integer(0);
  }

  const link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "journal.sqlite";
};

TEST_F(JournalFactsTest, AfterAnEndInOrderRevisionsContinue) {
  std::string run;
  {
    Run before(path_);
    EXPECT_FALSE(before.unclean) << "there was none before";
    before.publish(3);
    run = before.bus.read(0, 1).facts[0]->run;
    before.end();
  }
  Run now(path_);
  EXPECT_FALSE(now.unclean);
  EXPECT_EQ(now.bus.publish("other", stage::StopRequested{}, {}), 4u);
  EXPECT_THAT(now.revisions(), ElementsAre(1, 2, 3, 4));
  const FactPointer fact = now.bus.read(2, 1).facts[0];
  EXPECT_EQ(fact->run, run);
  EXPECT_EQ(fact->device, "stage");
  EXPECT_EQ(fact->time, WallTime(std::chrono::hours(1)));
  EXPECT_EQ(std::get<stage::CompletionSeen>(fact->fact).motion, 7u);
}

TEST_F(JournalFactsTest, AfterAnUncleanEndThereIsAGap) {
  { Run(path_).publish(3); }
  Run now(path_);
  EXPECT_TRUE(now.unclean);
  EXPECT_EQ(now.bus.newest_revision(), 3 + FactTable::kUnwrittenMost);
}

// A run may be killed before it has written any fact.
TEST_F(JournalFactsTest, EachRunBeginsBehindTheOneBefore) {
  { Run(path_).publish(3); }
  const std::uint64_t second = [&] { return Run(path_).bus.newest_revision() + 1; }();
  EXPECT_EQ(Run(path_).bus.newest_revision(), second + FactTable::kUnwrittenMost);
}

TEST_F(JournalFactsTest, ARunWhoseStartWasDroppedHasNotEnded) {
  { Run(path_).end(); }
  run_sql("UPDATE entry SET kind = 20");
  EXPECT_TRUE(Run(path_).unclean);
}

TEST_F(JournalFactsTest, TheFileHasTheNewestOnly) {
  {
    Run before(path_, 5);
    before.publish(12);
    before.end();
  }
  EXPECT_EQ(number("SELECT count(*) FROM fact"), 5);
  EXPECT_THAT(Run(path_, 5).revisions(), ElementsAre(8, 9, 10, 11, 12));
}

TEST_F(JournalFactsTest, FactsAreWrittenWithoutAnEntry) {
  Run run(path_);
  run.publish(1);
  const TimePoint limit = monotonic_now() + link_test::kPatience;
  while (number("SELECT count(*) FROM fact") < 1 && monotonic_now() < limit) {
  }
  EXPECT_EQ(number("SELECT count(*) FROM fact"), 1);
}

TEST_F(JournalFactsTest, OfARefusingDiskTheNewestWait) {
  {
    Run run(path_, 5);
    run_sql(
        "CREATE TABLE inserted(revision); CREATE TRIGGER note AFTER INSERT ON fact BEGIN INSERT INTO inserted "
        "VALUES(new.revision); END; ALTER TABLE entry RENAME TO away");
    run.journal->append({{.kind = EntryKind::stop_requested}});
    const TimePoint limit = monotonic_now() + link_test::kPatience;
    while (!run.journal->failure() && monotonic_now() < limit) {
    }
    run.publish(12);
    run_sql("ALTER TABLE away RENAME TO entry");
    run.end();
    while (run.journal->failure() && monotonic_now() < limit) {
    }
  }
  EXPECT_EQ(number("SELECT count(*) FROM inserted"), 5) << "the others did not wait";
  EXPECT_THAT(Run(path_, 5).revisions(), ElementsAre(8, 9, 10, 11, 12));
}

TEST_F(JournalFactsTest, ARowInAFactsPlaceDoesNotKeepTheJournalFromWriting) {
  {
    Run run(path_);
    run_sql("INSERT INTO fact VALUES(1, 0, '', '', 'x')");
    run.publish(1);
    run.end();
  }
  EXPECT_THAT(Run(path_).revisions(), ElementsAre(1));
}

TEST_F(JournalFactsTest, ARowThatIsNoFactIsLeftOut) {
  {
    Run before(path_);
    before.publish(3);
    before.end();
  }
  run_sql("UPDATE fact SET fact = 'x' WHERE revision = 2");
  EXPECT_THAT(Run(path_).revisions(), ElementsAre(1, 3));
}

// A journal as an earlier version left it.
class UpgradedJournal : public JournalFactsTest, public testing::WithParamInterface<const char*> {};

TEST_P(UpgradedJournal, KeepsItsEntriesAndTakesFacts) {
  { Run(path_).end(); }
  run_sql("DROP TABLE fact; DELETE FROM meta WHERE key = 'facts_begun'");
  run_sql(GetParam());
  {
    Run now(path_);
    EXPECT_THAT(now.revisions(), IsEmpty());
    now.publish(2);
    now.end();
    EXPECT_EQ(now.journal->read({}, 10)->size(), 4u);
  }
  EXPECT_THAT(Run(path_).revisions(), ElementsAre(1, 2));
}

INSTANTIATE_TEST_SUITE_P(OfEarlierVersions, UpgradedJournal,
                         testing::Values("PRAGMA user_version = 2",
                                         "DROP TABLE request; DROP INDEX entry_of_line; PRAGMA user_version = 1"));

}  // namespace
}  // namespace axisgate::server::journal_facts_test
