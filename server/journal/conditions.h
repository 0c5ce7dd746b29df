// Which entries are wanted, and what that is in SQL.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/journal/database.h"
#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Which entries are wanted. All, where nothing is said.
struct Filter {
  std::optional<WallTime> from{}, to{};  // from <= time < to
  std::string device{}, who{};
  std::string identity{};  // only entries by callers of this identity (access/access.h), and by nobody
  std::uint64_t motion = 0;
  std::vector<EntryKind> kinds{};
  std::int64_t before = 0;  // numbers below this one: where the page before ended
  std::int64_t after = 0;   // numbers above this one
  int axis = 0;             // that the body names; 0: all
  std::string outcome{};    // of an end of a motion: "FAILED"; empty: all entries
  std::string text{};       // a part of the body; capital and small letters differ
  bool oldest_first = false;
};

// SQL: the body of an entry. A file that was changed may have text there that is no JSON.
inline constexpr std::string_view kJsonBody = "iif(json_valid(body), body, '{}')";

// SQL: the entry is by a caller of one identity, which is bound to it, or by nobody.
inline constexpr std::string_view kOfIdentity =
    "(person = 0 OR person IN (SELECT id FROM person WHERE identity_of(name) = ?))";

// The conditions of a filter, each with what is bound to it.
class Conditions {
 public:
  void add(std::string_view condition, WallTime time) {
    add(condition, std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count());
  }
  void add(std::string_view condition, std::int64_t value) { add(condition), values_.emplace_back(value); }
  void add(std::string_view condition, std::string_view value) {
    add(condition), values_.emplace_back(std::string(value));
  }
  void add_any_of(const std::vector<EntryKind>& kinds);

  std::string sql() const { return sql_; }
  void bind(Statement& statement) const;

 private:
  void add(std::string_view condition);

  std::string sql_;
  std::vector<std::variant<std::int64_t, std::string>> values_;
};

Conditions conditions_of(const Filter& filter);

}  // namespace axisgate::server::journal
