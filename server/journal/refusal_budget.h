// How many refused requests have an entry of their own, so that a program that is refused in a loop does not shorten
// everybody's history.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/journal/entry.h"

namespace axisgate::server::journal {

// Not thread safe. `now` never decreases.
class RefusalBudget {
 public:
  // The first of one identity (access/identity_of) have entries, within a time that begins with the first of them.
  static constexpr std::int64_t kEntries = 60;
  static constexpr Duration kWithin = std::chrono::minutes(10);
  // Of more identities at once, the time of the one that began first ends early.
  static constexpr std::size_t kIdentitiesMax = 1000;

  // What is to be written now: the refusal, if it has an entry, after what due() says.
  std::vector<Entry> add(Entry refusal, TimePoint now);
  // Of each identity whose time has passed, those without an entry: the last of them, with their `count`.
  std::vector<Entry> due(TimePoint now);
  // The same of all identities, whose times end.
  std::vector<Entry> rest();
  // When due() may have something; nothing: not before the next add().
  std::optional<TimePoint> next_due() const;

 private:
  struct Refused {
    std::int64_t count = 0;
    Entry last{};
  };
  void end_oldest(std::vector<Entry>& sums);

  std::map<std::string, Refused> identities_;
  std::deque<std::pair<TimePoint, std::string>> began_;  // oldest first
};

}  // namespace axisgate::server::journal
