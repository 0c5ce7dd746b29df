// Limit on refused requests that have their own entry, so that a program that is refused in a loop does not shorten
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
#include "server/limits.h"

namespace axisgate::server::journal {

// Not thread safe. `now` never decreases.
class RefusalBudget {
 public:
  // Number of refusals of one identity (access/identity_of) that have entries, within a period that begins with its
  // first refusal.
  static constexpr std::int64_t kEntries = 60;
  // Maximum number of identities at once. A further identity ends the oldest period early.
  static constexpr std::size_t kIdentitiesMax = 1000;

  // Returns the entries to write now: those of due(), then the refusal if it has its own entry.
  std::vector<Entry> add(Entry refusal, TimePoint now);
  // Returns one entry for each identity whose period has passed: its last refusal, with the `count` of refusals without
  // an entry.
  std::vector<Entry> due(TimePoint now);
  // Ends the periods of all identities, and returns their entries like due().
  std::vector<Entry> rest();
  // Earliest time at which due() may return entries; nullopt: not before the next add().
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
