// Power cuts, which must lose no row of the journal whose append() has returned success.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/journal/store.h"
#include "tests/simulation/random.h"
#include "tests/unit/journal/journal_rows.h"
#include "tests/unit/journal/losing_disk.h"
#include "tests/unit/journal/losing_vfs.h"

namespace axisgate::server::journal::power_cut_test {
namespace {

using disk_test::LosingDisk;
using disk_test::LosingVfs;

const std::string kFile = "/journal.sqlite";

// A machine with the daemon's journal on its own disk.
class Machine {
 public:
  explicit Machine(LosingDisk::FileSyncs syncs = LosingDisk::FileSyncs::kept) : disk_(syncs), vfs_(disk_) {}

  LosingDisk& disk() { return disk_; }

  tl::expected<Store, Unopened> open() { return Store::open(kFile, vfs_.name()); }

  // Returns true if the rows were acknowledged. The program ends after a failure, so only its last rows can lack
  // acknowledgement.
  bool append(Store& store, std::size_t rows, std::size_t body_size = 40) {
    std::vector<Entry> group;
    for (std::size_t i = 1; i <= rows; ++i) group.push_back(journal_rows::entry(requested_.size() + i, body_size));
    requested_.insert(requested_.end(), group.begin(), group.end());
    if (!store.append(journal_rows::records_of(group))) return false;
    acknowledged_ = requested_.size();
    return true;
  }

  // Does what a commit does when the log has 1,000 pages. Afterwards the log starts again at its first byte.
  bool checkpoint() {
    auto database = Database::open(kFile, Database::Access::write, vfs_.name());
    return database && database->run("PRAGMA wal_checkpoint");
  }

  // Runs `program` and cuts the power as planned, or else at its end; returns true if the cut came before the end.
  template <class Program>
  bool run(Program program, const LosingDisk::Cut& cut) {
    disk_.plan(cut);
    program(*this);
    const bool was_cut = !disk_.has_power();
    if (!was_cut) disk_.cut_power(cut.seed);
    disk_.restore_power();
    return was_cut;
  }

  // Returns "" if all acknowledged rows are present, all or none of the last append(), nothing else, and a row can be
  // added; otherwise the fault.
  std::string fault() {
    auto store = open();
    if (!store) return store.error().problem.message;
    const auto rows = store->read({}, requested_.size() + 1);
    if (!rows) return rows.error().message;
    const bool complete = rows->size() == acknowledged_ || rows->size() == requested_.size();
    if (!complete || !journal_rows::begin_as(requested_, *rows, journal_rows::same)) {
      return fmt::format("{} rows of {} acknowledged and {} requested", rows->size(), acknowledged_, requested_.size());
    }
    requested_.resize(rows->size());
    if (!append(*store, 1)) return "no row can be added";
    const auto verdict = store->verify(std::nullopt);
    if (!verdict) return verdict.error().message;
    return verdict->first_bad ? fmt::format("row {}: {}", *verdict->first_bad, verdict->fault) : "";
  }

 private:
  LosingDisk disk_;
  LosingVfs vfs_;
  std::vector<Entry> requested_;  // in order
  std::size_t acknowledged_ = 0;
};

// Appends single rows and groups with checkpoints between them, closes the connection, which removes the log, and opens
// another.
void run_two_sessions(Machine& machine) {
  {
    auto store = machine.open();
    if (!store || !machine.append(*store, 1) || !machine.append(*store, 3) || !machine.checkpoint()) return;
    if (!machine.append(*store, 1) || !machine.append(*store, 4)) return;
  }
  auto store = machine.open();
  if (!store || !machine.append(*store, 2) || !machine.checkpoint()) return;
  if (machine.append(*store, 1)) machine.append(*store, 1);
}

// Cuts the power at the first sync, at the second, and so on, until `cut_at` returns false: its program ended before
// the cut. The seed decides which unsynced data survive.
template <class CutAt>
void at_each_sync(std::uint64_t seeds, CutAt cut_at) {
  bool was_cut = true;
  for (int sync = 1; was_cut; ++sync) {
    for (const bool after : {false, true}) {
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SCOPED_TRACE(fmt::format("the power is cut {} sync {}, seed {}", after ? "after" : "at", sync, seed));
        was_cut = cut_at(LosingDisk::Cut{.sync = sync, .after = after, .seed = seed});
      }
    }
  }
}

TEST(JournalPowerCut, AtAnySyncLosesNoAcknowledgedRow) {
  at_each_sync(10, [](const LosingDisk::Cut& cut) {
    Machine machine;
    const bool was_cut = machine.run(run_two_sessions, cut);
    EXPECT_EQ(machine.fault(), "");
    return was_cut;
  });
}

TEST(JournalPowerCut, WhileTheJournalRecoversFromACutLosesNoAcknowledgedRow) {
  at_each_sync(1, [](const LosingDisk::Cut& first) {
    bool was_cut = true;
    at_each_sync(2, [&](const LosingDisk::Cut& second) {
      Machine machine;
      was_cut = machine.run(run_two_sessions, first);
      const bool was_cut_again = machine.run([](Machine& one) { (void)one.open(); }, second);
      EXPECT_EQ(machine.fault(), "");
      return was_cut_again;
    });
    return was_cut;
  });
}

TEST(JournalPowerCut, ManyTimesLosesNoAcknowledgedRow) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    simulation::Random random(seed);
    Machine machine;
    for (int round = 1; round <= 20; ++round) {
      SCOPED_TRACE(fmt::format("seed {}, round {}", seed, round));
      machine.run(run_two_sessions, {static_cast<int>(random.between(1, 30)), random.chance(0.5), random.next()});
      EXPECT_EQ(machine.fault(), "");
    }
  }
}

// SQLite's page cache has 2 MB: most of the group is in the log before its commit, which then runs a checkpoint.
void append_large_group(Machine& machine) {
  auto store = machine.open();
  if (store && machine.append(*store, 1)) machine.append(*store, 90, 50'000);
}

TEST(JournalPowerCut, InAGroupThatIsLargerThanTheCacheLosesNoAcknowledgedRow) {
  {
    Machine machine;
    auto store = *machine.open();
    ASSERT_TRUE(machine.append(store, 90, 50'000));
    EXPECT_GT(machine.disk().find(kFile)->bytes().size(), 4'000'000u) << "no checkpoint";
  }
  at_each_sync(1, [](const LosingDisk::Cut& cut) {
    Machine machine;
    const bool was_cut = machine.run(append_large_group, cut);
    EXPECT_EQ(machine.fault(), "");
    return was_cut;
  });
}

// Shows that these tests can fail.
TEST(JournalPowerCut, LosesAcknowledgedRowsOnADiskThatIgnoresSyncs) {
  int lost = 0;
  at_each_sync(4, [&](const LosingDisk::Cut& cut) {
    Machine machine(LosingDisk::FileSyncs::ignored);
    const bool was_cut = machine.run(run_two_sessions, cut);
    const std::string fault = machine.fault();
    lost += fault.find("acknowledged") != std::string::npos ? 1 : 0;
    return was_cut;
  });
  EXPECT_GT(lost, 0);
}

}  // namespace
}  // namespace axisgate::server::journal::power_cut_test
