// Rows for tests that damage a journal; no two are equal.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "server/journal/store.h"

namespace axisgate::server::journal_rows {

// Returns the row of that number. Every third row names a new person.
inline journal::Entry entry(std::size_t number, std::size_t body_size = 40) {
  return {.kind = journal::EntryKind::motion_ended,
          .time = WallTime(std::chrono::seconds(number)),
          .boot_time = TimePoint(std::chrono::seconds(number)),
          .device = "stage",
          .who = fmt::format("unix {}", number / 3),
          .motion = number,
          .body = std::string(body_size, static_cast<char>('a' + number % 26))};
}

inline std::vector<journal::Record> records_of(const std::vector<journal::Entry>& entries) {
  std::vector<journal::Record> records;
  for (const journal::Entry& entry : entries) records.push_back({entry});
  return records;
}

// Compares everything that the chain of hashes covers.
inline bool same_but_for_names(const journal::Entry& one, const journal::Entry& other) {
  return one.kind == other.kind && one.time == other.time && one.boot_time == other.boot_time &&
         one.device == other.device && one.motion == other.motion && one.body == other.body;
}

inline bool same(const journal::Entry& one, const journal::Entry& other) {
  return same_but_for_names(one, other) && one.who == other.who;
}

// Reports whether the rows, newest first, are the first rows of `wanted` or all of them.
inline bool begin_as(const std::vector<journal::Entry>& wanted, const std::vector<journal::StoredEntry>& rows,
                     bool (*equal)(const journal::Entry&, const journal::Entry&)) {
  return rows.size() <= wanted.size() && std::equal(rows.rbegin(), rows.rend(), wanted.begin(),
                                                    [&](const journal::StoredEntry& row, const journal::Entry& entry) {
                                                      return equal(row.entry, entry);
                                                    });
}

}  // namespace axisgate::server::journal_rows
