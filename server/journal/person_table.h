// The names of those who called, in the journal's file. They are outside the chain, so that a name can be erased.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "server/journal/database.h"

namespace axisgate::server::journal {

// What the file has of a caller.
struct NamedPerson {
  std::int64_t number = 0;
  std::int64_t entries = 0;   // by this caller
  std::int64_t requests = 0;  // remembered ones (request_table.h) that have the name, by any caller
};

// "erased 3": what takes the place of an erased name.
std::string erased_name(std::int64_t number);

// Of one Database, which outlives it. Not thread safe.
class PersonTable {
 public:
  static constexpr const char* kMake = "CREATE TABLE person(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE) STRICT;";

  explicit PersonTable(Database& database) : database_(database) {}

  // Made with the first entry that names it. 0: nobody, of an empty name.
  Result<std::int64_t> number_of(std::string_view name);
  // Nothing: no entry names this caller, or the name was erased.
  Result<std::optional<NamedPerson>> find(std::string_view name);
  // Within a transaction. The name becomes erased_name(). The file has it no longer when its log has been emptied, too:
  // Database::empty_log().
  Result<void> erase(std::int64_t number);

 private:
  Database& database_;
};

}  // namespace axisgate::server::journal
