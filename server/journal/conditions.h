// Filter of journal entries, and its translation to SQL.
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

// A Filter selects entries. A member with its default value restricts nothing.
struct Filter {
  std::optional<WallTime> from{}, to{};  // from <= time < to
  std::string device{}, who{};
  std::string identity{};  // only entries by callers of this identity (access/access.h), and entries without a caller
  std::uint64_t motion = 0;
  std::vector<EntryKind> kinds{};
  std::int64_t before = 0;  // only numbers below this one: the end of the previous page
  std::int64_t after = 0;   // only numbers above this one
  int axis = 0;             // an axis that the body names; 0: all entries
  std::string outcome{};    // outcome of a motion, such as "FAILED"; empty: all entries
  std::string text{};       // text that the body contains; case-sensitive
  bool oldest_first = false;
};

// SQL for the body of an entry. A file that was changed may have text there that is not JSON.
inline constexpr std::string_view kJsonBody = "iif(json_valid(body), body, '{}')";

// SQL condition: the entry has no caller, or its caller has the identity that is bound to the parameter.
inline constexpr std::string_view kOfIdentity =
    "(person = 0 OR person IN (SELECT id FROM person WHERE identity_of(name) = ?))";

// SQL conditions of a filter, with the values that are bound to their parameters.
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
