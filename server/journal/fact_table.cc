#include "server/journal/fact_table.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "server/journal/fact_text.h"
#include "server/journal/person_table.h"

namespace axisgate::server::journal {
namespace {

// Returns null if somebody has changed the row and it is no longer a fact.
FactPointer fact_of(const Statement& row) {
  auto record = fact_in(row.bytes(4));
  if (!record) return nullptr;
  record->revision = static_cast<std::uint64_t>(row.integer(0));
  record->time = row.time(1);
  record->run = row.bytes(2);
  record->device = row.bytes(3);
  return std::make_shared<const FactRecord>(*std::move(record));
}

}  // namespace

Result<void> FactTable::change(const FactChange& change) {
  if (change.added.empty()) return {};
  // Replaces existing rows: a row that somebody inserted with this revision must not keep the journal from writing.
  auto insert = database_.prepare("INSERT OR REPLACE INTO fact VALUES(?, ?, ?, ?, ?)");
  if (!insert) return tl::unexpected(insert.error());
  for (const FactPointer& record : change.added) {
    if (auto done = add(*record, *insert); !done) return done;
  }
  auto remove = database_.prepare("DELETE FROM fact WHERE revision < ?");
  if (!remove) return tl::unexpected(remove.error());
  return remove->bind(1, static_cast<std::int64_t>(change.oldest)).step().map([](bool) {});
}

Result<void> FactTable::add(const FactRecord& record, Statement& insert) {
  insert.reset();
  insert.bind(1, static_cast<std::int64_t>(record.revision)).bind(2, record.time).bind(3, record.run);
  return insert.bind(4, record.device).bind(5, text_of(record)).step().map([](bool) {});
}

Result<void> FactTable::erase(std::int64_t person) {
  return database_.run(fmt::format("UPDATE fact SET fact = replace(fact, name || '\"', '{}\"') FROM person "
                                   "WHERE person.id = {} AND instr(fact, name || '\"') > 0",
                                   erased_name(person), person)
                           .c_str());
}

Result<std::vector<FactPointer>> FactTable::read() {
  auto rows = database_.prepare("SELECT revision, time_us, run, device, fact FROM fact ORDER BY revision");
  if (!rows) return tl::unexpected(rows.error());
  std::vector<FactPointer> found;
  while (true) {
    const auto row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return found;
    if (FactPointer record = fact_of(*rows)) found.push_back(std::move(record));
  }
}

// Highest revision that may have been given to an event; 0: none.
Result<std::uint64_t> FactTable::last_revision() {
  auto last = database_.prepare(
      "SELECT max(coalesce((SELECT max(revision) FROM fact), 0), "
      "coalesce((SELECT CAST(value AS INTEGER) FROM meta WHERE key = 'facts_begun'), 0))");
  if (!last) return tl::unexpected(last.error());
  return last->step().map([&](bool) { return static_cast<std::uint64_t>(last->integer(0)); });
}

Result<FactsBefore> FactTable::begin(bool after_unclean_end) {
  auto facts = read();
  if (!facts) return tl::unexpected(facts.error());
  const auto last = last_revision();
  if (!last) return tl::unexpected(last.error());
  const std::uint64_t first = *last + 1 + (after_unclean_end ? kUnwrittenMost : 0);
  const auto noted =
      database_.run(fmt::format("INSERT OR REPLACE INTO meta VALUES('facts_begun', '{}')", first).c_str());
  if (!noted) return tl::unexpected(noted.error());
  return FactsBefore{*std::move(facts), first};
}

}  // namespace axisgate::server::journal
