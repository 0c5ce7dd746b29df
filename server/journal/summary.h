// What happened within some time, such as a night: few enough facts for one screen.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/events/wall_time.h"
#include "server/journal/database.h"

namespace axisgate::server::journal {

// from <= time < to.
struct Span {
  WallTime from = WallTime::min(), to = WallTime::max();
  std::string device{};    // empty: all
  std::string identity{};  // only entries by callers of this identity (access/access.h), and by nobody; empty: all
};

// The texts are those of the entries.
struct MotionCount {
  std::string kind, outcome;  // "move", "SUCCEEDED"
  std::int64_t count = 0;
};

struct PersonSummary {
  std::string who;                   // empty: nobody
  WallTime first, last;              // of the caller's entries
  std::vector<MotionCount> motions;  // that ended
  std::int64_t refused = 0;          // requests
};

struct StopSummary {
  WallTime time;
  std::string who, device;
  bool emergency = false;
};

// A late stop: a caller was notified that it stays open.
struct LateStop {
  WallTime time;  // when it ended
  std::string who, device;
  bool emergency = false;
  Duration after{};        // since it was requested
  bool confirmed = false;  // false: withdrawn
};

// A condition of a stage that began or ended (device/stage/condition.h).
struct ConditionSummary {
  WallTime seen;                     // by the first reading that showed it
  std::optional<WallTime> before{};  // the reading before; nothing: there was none
  std::string device;
  std::string condition;  // its name
  std::vector<int> axes;  // empty: of the whole controller
  bool begun = false;
  std::string value;  // the mode or the command format
};

struct LinkLoss {
  std::string device;
  WallTime down;               // may be before the span
  std::optional<WallTime> up;  // may be after it; nothing: not up again
};

struct DaemonStart {
  WallTime time;
  bool after_unclean_end = false;  // the run before has no end
};

// Of many the first, and how many more there are.
template <class Item>
struct Listed {
  static constexpr std::size_t kMax = 100;

  std::vector<Item> items;
  std::int64_t more = 0;

  void add(Item item) {
    if (items.size() < kMax) return items.push_back(std::move(item));
    ++more;
  }
};

// Each in the order of its times.
struct Summary {
  Listed<PersonSummary> persons;
  Listed<StopSummary> stops;
  Listed<LateStop> late_stops;
  Listed<ConditionSummary> conditions;
  Listed<LinkLoss> losses;
  Listed<DaemonStart> starts;  // in the order of their entries, whatever the span's device
};

// Reads each entry of the span once, and few outside it: a million entries take a second.
Result<Summary> summarize(Database& database, const Span& span);

}  // namespace axisgate::server::journal
