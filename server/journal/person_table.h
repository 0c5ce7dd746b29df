// Names of callers in the journal's file. They are outside the chain, so that a name can be erased.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "server/journal/database.h"

namespace axisgate::server::journal {

// A caller's number, and how often the file refers to them.
struct NamedPerson {
  std::int64_t number = 0;
  std::int64_t entries = 0;   // number of entries by this caller
  std::int64_t requests = 0;  // remembered requests of any caller (request_table.h) that contain the name
};

// Returns the replacement for an erased name, such as "erased 3".
std::string erased_name(std::int64_t number);

// Names in a Database, which must outlive this object. Not thread safe.
class PersonTable {
 public:
  static constexpr const char* kMake = "CREATE TABLE person(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE) STRICT;";

  explicit PersonTable(Database& database) : database_(database) {}

  // Returns the caller's number, which is created with the first entry that names them. 0 for an empty name.
  Result<std::int64_t> number_of(std::string_view name);
  // Returns nullopt if no entry names this caller, or if the name was erased.
  Result<std::optional<NamedPerson>> find(std::string_view name);
  // Replaces the name with erased_name(). Call within a transaction. The bytes leave the file only when its log is
  // emptied, too: Database::empty_log().
  Result<void> erase(std::int64_t number);

 private:
  Database& database_;
};

}  // namespace axisgate::server::journal
