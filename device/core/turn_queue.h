// Work of many callers, who take turns; each caller's own work keeps its order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "device/core/guard.h"

namespace axisgate {

// Queue of work. The cost of take() does not depend on how much work waits, as long as the first work of a caller is
// admissible. Not thread safe.
template <class Work>
class TurnQueue {
 public:
  void push(std::string name, Work work) {
    Caller& caller = callers_[std::move(name)];
    caller.waiting.push_back({++pushed_, std::move(work)});
    ++size_;
    if (caller.waiting.size() == 1) order_.emplace(place_of(caller), &caller);
  }

  std::size_t size() const { return size_; }
  std::size_t size_of(const std::string& name) const {
    const auto found = callers_.find(name);
    return found == callers_.end() ? 0 : found->second.waiting.size();
  }

  // Takes the first admissible work of the caller whose last turn was the longest ago. Turns are forgotten when no work
  // waits.
  template <class Admissible>
  std::optional<Work> take(Admissible& admissible) {
    for (auto turn = order_.begin(); turn != order_.end(); ++turn) {
      Caller& caller = *turn->second;
      const auto chosen = std::ranges::find_if(caller.waiting, admissible, &Entry::work);
      if (chosen == caller.waiting.end()) continue;
      Work work = std::move(chosen->work);
      caller.waiting.erase(chosen);
      order_.erase(turn);
      caller.last_turn = ++taken_;
      if (!caller.waiting.empty()) order_.emplace(place_of(caller), &caller);
      --size_;
      forget_if_empty();
      return work;
    }
    return {};
  }

  // Removes all work for which chosen(work) is true. Returns it in the order in which it came.
  template <class Chosen>
  std::vector<Work> remove(Chosen chosen) {
    std::vector<Entry> removed;
    if (any_of(chosen)) {
      order_.clear();
      for (auto& [name, caller] : callers_) {
        const auto out = std::stable_partition(caller.waiting.begin(), caller.waiting.end(),
                                               [&](const Entry& entry) { return !chosen(entry.work); });
        std::move(out, caller.waiting.end(), std::back_inserter(removed));
        caller.waiting.erase(out, caller.waiting.end());
        if (!caller.waiting.empty()) order_.emplace(place_of(caller), &caller);
      }
      size_ -= removed.size();
      forget_if_empty();
    }
    std::ranges::sort(removed, {}, &Entry::number);
    std::vector<Work> work;
    for (Entry& entry : removed) work.push_back(std::move(entry.work));
    return work;
  }

  template <class Holds>
  bool any_of(Holds holds) const {
    return std::ranges::any_of(order_, [&](const auto& turn) {
      return std::ranges::any_of(turn.second->waiting, [&](const Entry& entry) { return holds(entry.work); });
    });
  }

  // Visits the work by the last turn of each caller, and then in the order in which it came.
  template <class Visit>
  void for_each_in_turn(Visit visit) const {
    std::vector<std::tuple<std::uint64_t, std::uint64_t, const Work*>> all;
    for (const auto& [place, caller] : order_) {
      for (const Entry& entry : caller->waiting) all.emplace_back(place.first, entry.number, &entry.work);
    }
    std::ranges::sort(all);
    for (const auto& [turn, number, work] : all) visit(*work);
  }

  // Visits all work in no particular order.
  template <class Visit>
  void for_each(Visit visit) const {
    for (const auto& [place, caller] : order_) {
      for (const Entry& entry : caller->waiting) visit(entry.work);
    }
  }

 private:
  struct Entry {
    std::uint64_t number;
    Work work;
  };
  struct Caller {
    std::deque<Entry> waiting;
    std::uint64_t last_turn = 0;  // 0: none yet
  };
  // The caller's last turn; the number of the caller's first work.
  using Place = std::pair<std::uint64_t, std::uint64_t>;

  static Place place_of(const Caller& caller) {
    return {guarded(Guard::callers_take_turns) ? caller.last_turn : 0, caller.waiting.front().number};
  }
  void forget_if_empty() {
    if (size_ == 0) callers_.clear();
  }

  std::map<std::string, Caller> callers_;
  std::map<Place, Caller*> order_;  // callers that have waiting work
  std::size_t size_ = 0;
  std::uint64_t pushed_ = 0, taken_ = 0;
};

}  // namespace axisgate
