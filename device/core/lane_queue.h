// Waiting work in lanes: a stop before everything, polls last, and nobody waits for ever.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/core/guard.h"
#include "device/core/lane.h"
#include "device/core/problem.h"

namespace axisgate {

// Why a lane takes nothing more: queue_full, with when to try again.
tl::unexpected<Problem> lane_full(Lane lane, std::size_t waiting);
tl::unexpected<Problem> share_full(Lane lane, const std::string& caller, std::size_t waiting);

// Policy, in this order:
// - at most every second take is a stop while anything else waits;
// - a lane passed over kPassesMax times in a row goes first once, so that questions and polls do not starve;
// - otherwise the first lane that has admissible work;
// - within a lane callers take turns, and each caller's own work keeps its order.
template <class Work>
class LaneQueue {
 public:
  static constexpr std::size_t kLaneMax = 1024;
  static constexpr std::size_t kShareMax = kLaneMax / 4;  // of what one caller may have waiting in a lane
  static constexpr int kPassesMax = 8;

  // `work` is not taken where the lane is full, or holds `share` of this caller's already: queue_full.
  Result<void> push(Lane lane, std::string caller, Work work, std::size_t share = kLaneMax) {
    auto& waiting = lanes_[index(lane)].waiting;
    if (guarded(Guard::lanes_bounded) && waiting.size() >= kLaneMax) return lane_full(lane, waiting.size());
    if (share < kLaneMax && guarded(Guard::shares_bounded)) {
      const auto own = static_cast<std::size_t>(std::ranges::count(waiting, caller, &Entry::caller));
      if (own >= share) return share_full(lane, caller, own);
    }
    waiting.push_back({std::move(caller), std::move(work)});
    return {};
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

  // In the order in which take() would hand it over if all of it was admissible now: by the last turn of each caller.
  template <class Visit>
  void for_each_in_turn(Lane number, Visit visit) const {
    const auto& lane = lanes_[index(number)];
    std::vector<std::pair<std::uint64_t, const Work*>> order;
    for (const auto& entry : lane.waiting) order.emplace_back(lane.last_turn(entry.caller), &entry.work);
    const auto turn_of = [](const auto& one) { return one.first; };
    if (guarded(Guard::callers_take_turns)) std::ranges::stable_sort(order, {}, turn_of);
    for (const auto& [turn, work] : order) visit(*work);
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

    std::uint64_t last_turn(const std::string& caller) const {  // 0: none since the lane was empty
      const auto found = served.find(caller);
      return found == served.end() ? 0 : found->second;
    }
  };
  static std::size_t index(Lane lane) { return static_cast<std::size_t>(lane); }

  template <class Admissible>
  std::optional<Work> take_from(std::size_t number, Admissible& admissible) {
    auto& lane = lanes_[number];
    auto chosen = lane.waiting.end();
    std::uint64_t chosen_served = 0;
    for (auto entry = lane.waiting.begin(); entry != lane.waiting.end(); ++entry) {
      if (!admissible(entry->work)) continue;
      const auto when = lane.last_turn(entry->caller);
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
