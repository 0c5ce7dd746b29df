// Newest facts in the journal's file, so that readers of events can resume after a restart. They are outside the chain,
// because old facts are deleted.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "device/core/problem.h"
#include "server/events/event_bus.h"
#include "server/journal/database.h"

namespace axisgate::server::journal {

// Changes that are written together.
struct FactChange {
  std::deque<FactPointer> added{};  // ordered by revision
  std::uint64_t oldest = 0;         // facts with lower revisions are deleted
};

// Facts in a Database, which must outlive this object. Not thread safe.
class FactTable {
 public:
  static constexpr const char* kMake = R"(
CREATE TABLE fact(
  revision INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, run TEXT NOT NULL, device TEXT NOT NULL,
  fact TEXT NOT NULL) STRICT;
)";
  // Number of revisions that are skipped after an unclean end, because the last published facts may not have been
  // written. A path with segments of 60 ms has 50 facts a second, so the disk would have to refuse them for half an
  // hour before more were lost. Even then `run` distinguishes revisions that were given twice.
  static constexpr std::uint64_t kUnwrittenMost = 100'000;

  explicit FactTable(Database& database) : database_(database) {}

  Result<void> change(const FactChange& change);
  // Returns the facts of earlier runs, and the first revision of the new run. The first revision is on the disk when
  // this returns, so no later run begins with it again.
  Result<FactsBefore> begin(bool after_unclean_end);
  // Replaces the person's name wherever a text of a fact ends with it. Call within a transaction, before
  // PersonTable::erase().
  Result<void> erase(std::int64_t person);

 private:
  static Result<void> add(const FactRecord& record, Statement& insert);
  Result<std::vector<FactPointer>> read();
  Result<std::uint64_t> last_revision();

  Database& database_;
};

}  // namespace axisgate::server::journal
