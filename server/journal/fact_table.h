// The newest facts in the journal's file, so that readers of events resume over a restart. They are outside the chain,
// since they are forgotten again.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "device/core/problem.h"
#include "server/events/event_bus.h"
#include "server/journal/database.h"

namespace axisgate::server::journal {

// What is written together.
struct FactChange {
  std::deque<FactPointer> added{};  // by revision
  std::uint64_t oldest = 0;         // those below it are forgotten
};

// Of one Database, which outlives it. Not thread safe.
class FactTable {
 public:
  static constexpr const char* kMake = R"(
CREATE TABLE fact(
  revision INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, run TEXT NOT NULL, device TEXT NOT NULL,
  fact TEXT NOT NULL) STRICT;
)";
  // So many revisions are left out after an unclean end, because facts that were published last may not have been
  // written. A path with segments of 60 ms has 50 facts a second: the disk would have to refuse them for half an hour
  // before more were lost. Even then `run` distinguishes those that were given twice.
  static constexpr std::uint64_t kUnwrittenMost = 100'000;

  explicit FactTable(Database& database) : database_(database) {}

  Result<void> change(const FactChange& change);
  // The facts of earlier runs, and the first revision of a new one. That is on the disk when it returns, so that no
  // later run begins with the same.
  Result<FactsBefore> begin(bool after_unclean_end);
  // Within a transaction, before PersonTable::erase(): the name of that person, wherever a text of a fact ends with it.
  Result<void> erase(std::int64_t person);

 private:
  static Result<void> add(const FactRecord& record, Statement& insert);
  Result<std::vector<FactPointer>> read();
  Result<std::uint64_t> last_revision();

  Database& database_;
};

}  // namespace axisgate::server::journal
