// Waiting work in lanes: a stop before everything, polls last, and nobody waits for ever.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/core/lane.h"

namespace axisgate {

// Policy, in this order:
// - at most every second take is a stop while anything else waits;
// - a lane passed over kPassesMax times in a row goes first once, so that questions and polls do not starve;
// - otherwise the first lane that has admissible work;
// - within a lane callers take turns, and each caller's own work keeps its order.
template <class Work>
class LaneQueue {
 public:
  static constexpr std::size_t kLaneMax = 1024;
  static constexpr int kPassesMax = 8;

  // False: the lane is full, and `work` was not taken.
  bool push(Lane lane, std::string caller, Work work) {
    auto& queue = lanes_[index(lane)];
    if (guarded(Guard::lanes_bounded) && queue.waiting.size() >= kLaneMax) return false;
    queue.waiting.push_back({std::move(caller), std::move(work)});
    return true;
  }

  // The next work for which admissible(work) holds.
  template <class Admissible>
  std::optional<Work> take(Admissible admissible) {
    for (const bool stops_wait : {!stops_turn(), false}) {
      for (const bool starving_only : {guarded(Guard::lanes_starve_not), false}) {
        for (std::size_t lane = stops_wait ? 1 : 0; lane < kLaneCount; ++lane) {
          if (starving_only && (lane == 0 || lanes_[lane].passes < kPassesMax)) continue;
          if (auto work = take_from(lane, admissible)) return work;
        }
      }
    }
    return {};
  }

  // Removes and hands over all work for which chosen(work) holds.
  template <class Chosen, class Consume>
  void drain(Chosen chosen, Consume consume) {
    std::deque<Work> out;
    for (auto& lane : lanes_) {
      std::deque<Entry> kept;
      for (auto& entry : lane.waiting) {
        if (chosen(entry.work)) {
          out.push_back(std::move(entry.work));
        } else {
          kept.push_back(std::move(entry));
        }
      }
      lane.waiting = std::move(kept);
    }
    for (auto& work : out) consume(std::move(work));
  }

  template <class Visit>
  void for_each(Visit visit) const {
    for (const auto& lane : lanes_) {
      for (const auto& entry : lane.waiting) visit(entry.work);
    }
  }

  // Whether a stop would not have to let others go first.
  bool stops_turn() const { return !last_was_stop_ || !guarded(Guard::stops_by_turns); }

  std::size_t size(Lane lane) const { return lanes_[index(lane)].waiting.size(); }

 private:
  struct Entry {
    std::string caller;
    Work work;
  };
  struct OneLane {
    std::deque<Entry> waiting;
    std::map<std::string, std::uint64_t> served;  // when each caller had its last turn
    int passes = 0;
  };
  static std::size_t index(Lane lane) { return static_cast<std::size_t>(lane); }

  template <class Admissible>
  std::optional<Work> take_from(std::size_t number, Admissible& admissible) {
    auto& lane = lanes_[number];
    auto chosen = lane.waiting.end();
    std::uint64_t chosen_served = 0;
    for (auto entry = lane.waiting.begin(); entry != lane.waiting.end(); ++entry) {
      if (!admissible(entry->work)) continue;
      const auto served = lane.served.find(entry->caller);
      const auto when = served == lane.served.end() ? 0 : served->second;
      if (chosen == lane.waiting.end() || when < chosen_served) {
        chosen = entry;
        chosen_served = when;
      }
      if (when == 0 || !guarded(Guard::callers_take_turns)) break;
    }
    if (chosen == lane.waiting.end()) return {};
    Work work = std::move(chosen->work);
    lane.served[chosen->caller] = ++takes_;
    lane.waiting.erase(chosen);
    if (lane.waiting.empty()) lane.served.clear();
    lane.passes = 0;
    last_was_stop_ = number == 0;
    for (std::size_t below = number + 1; below < kLaneCount; ++below) {
      if (!lanes_[below].waiting.empty()) ++lanes_[below].passes;
    }
    return work;
  }

  std::array<OneLane, kLaneCount> lanes_;
  bool last_was_stop_ = false;
  std::uint64_t takes_ = 0;
};

}  // namespace axisgate
