// Waiting work in lanes: stops come first, polls come last, and no work waits forever.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/core/guard.h"
#include "device/core/lane.h"
#include "device/core/problem.h"
#include "device/core/turn_queue.h"

namespace axisgate {

// Return queue_full as the reason why a lane accepts no more work, with a hint when to try again.
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
  static constexpr std::size_t kShareMax = kLaneMax / 4;  // limit of work of one caller in a lane
  static constexpr int kPassesMax = 8;

  // Adds work. Fails with queue_full if the lane is full, or if this caller already has `share` items in it.
  Result<void> push(Lane lane, std::string caller, Work work, std::size_t share = kLaneMax) {
    auto& waiting = lanes_[index(lane)].waiting;
    if (guarded(Guard::lanes_bounded) && waiting.size() >= kLaneMax) return lane_full(lane, waiting.size());
    const std::size_t own = waiting.size_of(caller);
    if (share < kLaneMax && own >= share && guarded(Guard::shares_bounded)) return share_full(lane, caller, own);
    waiting.push(std::move(caller), std::move(work));
    return {};
  }

  // Takes the next work for which admissible(work) is true.
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

  // Removes all work for which chosen(work) is true, and passes it to `consume`.
  template <class Chosen, class Consume>
  void drain(Chosen chosen, Consume consume) {
    std::vector<Work> removed;
    for (auto& lane : lanes_) std::ranges::move(lane.waiting.remove(chosen), std::back_inserter(removed));
    for (auto& work : removed) consume(std::move(work));
  }

  template <class Holds>
  bool any_of(Holds holds) const {
    return std::ranges::any_of(lanes_, [&](const OneLane& lane) { return lane.waiting.any_of(holds); });
  }

  // Visits all work in no particular order.
  template <class Visit>
  void for_each(Visit visit) const {
    for (const auto& lane : lanes_) lane.waiting.for_each(visit);
  }

  // Visits the work of a lane in the order in which take() would return it if all of it was admissible now: by the last
  // turn of each caller.
  template <class Visit>
  void for_each_in_turn(Lane lane, Visit visit) const {
    lanes_[index(lane)].waiting.for_each_in_turn(visit);
  }

  // Reports whether a stop may be taken now, without letting other work go first.
  bool stops_turn() const { return !last_was_stop_ || !guarded(Guard::stops_by_turns); }

  std::size_t size(Lane lane) const { return lanes_[index(lane)].waiting.size(); }

 private:
  struct OneLane {
    TurnQueue<Work> waiting;
    int passes = 0;
  };
  static std::size_t index(Lane lane) { return static_cast<std::size_t>(lane); }

  template <class Admissible>
  std::optional<Work> take_from(std::size_t number, Admissible& admissible) {
    auto& lane = lanes_[number];
    auto work = lane.waiting.take(admissible);
    if (!work) return {};
    lane.passes = 0;
    last_was_stop_ = number == 0;
    for (std::size_t below = number + 1; below < kLaneCount; ++below) {
      if (lanes_[below].waiting.size() > 0) ++lanes_[below].passes;
    }
    return work;
  }

  std::array<OneLane, kLaneCount> lanes_;
  bool last_was_stop_ = false;
};

}  // namespace axisgate
