// Summary of a period, such as a night, with few enough facts for one screen.
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
  std::string device{};  // empty: all
  // Only entries by callers of this identity (access/access.h), and entries without a caller; empty: all.
  std::string identity{};
};

// The texts are those of the entries.
struct MotionCount {
  std::string kind, outcome;  // "move", "SUCCEEDED"
  std::int64_t count = 0;
};

struct PersonSummary {
  std::string who;                   // empty: none
  WallTime first, last;              // times of the caller's first and last entry
  std::vector<MotionCount> motions;  // motions that ended
  std::int64_t refused = 0;          // number of refused requests
};

struct StopSummary {
  WallTime time;
  std::string who, device;
  bool emergency = false;
};

// A late stop: a caller was notified that it stays open.
struct LateStop {
  WallTime time;  // end of the stop
  std::string who, device;
  bool emergency = false;
  Duration after{};        // since it was requested
  bool confirmed = false;  // false: withdrawn
};

// A condition of a stage that began or ended (device/stage/condition.h).
struct ConditionSummary {
  WallTime seen;                     // time of the first poll that showed it
  std::optional<WallTime> before{};  // time of the poll before it; nullopt if there was none
  std::string device;
  std::string condition;  // name of the condition
  std::vector<int> axes;  // empty: the whole controller
  bool begun = false;
  std::string value;  // the mode or the command format
};

struct LinkLoss {
  std::string device;
  WallTime down;               // may be before the span
  std::optional<WallTime> up;  // may be after the span; nullopt if not up again
};

struct DaemonStart {
  WallTime time;
  bool after_unclean_end = false;  // the previous run has no end
};

// First items of a list, and the number of further ones.
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

// Each list is in the order of its times.
struct Summary {
  Listed<PersonSummary> persons;
  Listed<StopSummary> stops;
  Listed<LateStop> late_stops;
  Listed<ConditionSummary> conditions;
  Listed<LinkLoss> losses;
  Listed<DaemonStart> starts;  // in the order of their entries, for all devices
};

// Reads each entry of the span once, and few outside it: a million entries take a second.
Result<Summary> summarize(Database& database, const Span& span);

}  // namespace axisgate::server::journal
