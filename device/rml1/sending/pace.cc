#include "device/rml1/sending/pace.h"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace axisgate::rml1 {

void Pace::arrived(std::uint64_t through, TimePoint at) {
  const auto& steps = timeline_.steps();
  for (; next_ < steps.size() && steps[next_].end <= through; ++next_) {
    const std::chrono::duration<double> takes(steps[next_].*duration_ * slower_);
    add(steps[next_].end, at, std::chrono::duration_cast<Duration>(takes));
  }
  // Bytes that cause no step have been executed when the step before them has ended.
  add(through, at, {});
}

// A command with several steps has been executed when its last step has ended.
void Pace::add(std::uint64_t end, TimePoint arrived, Duration takes) {
  free_ = std::max(free_, arrived) + takes;
  if (unexecuted_.empty() || unexecuted_.back().end != end) unexecuted_.push_back({end, arrived, {}, {}});
  unexecuted_.back().takes += takes;
  unexecuted_.back().at = free_;
}

void Pace::not_arrived(std::uint64_t arrived_bytes, Duration a_byte, TimePoint now) {
  const auto first = std::ranges::upper_bound(unexecuted_, arrived_bytes, {}, &Ending::end);
  if (first == unexecuted_.end()) return;
  TimePoint free = first == unexecuted_.begin() ? TimePoint{} : std::prev(first)->at;
  for (auto one = first; one != unexecuted_.end(); ++one) {
    one->arrived = std::max(one->arrived, now + static_cast<Duration::rep>(one->end - arrived_bytes) * a_byte);
    one->at = free = std::max({one->at, free + one->takes, one->arrived + one->takes});
  }
  free_ = free;
}

void Pace::has_read(std::uint64_t bytes, TimePoint now) {
  executed(now);
  const auto unread = std::ranges::upper_bound(unexecuted_, bytes, {}, &Ending::end);
  if (unread == unexecuted_.begin()) return;
  for (auto before = unread - unexecuted_.begin(); before > 1; --before) {
    executed_ = unexecuted_.front().end;
    unexecuted_.pop_front();
  }
  free_ = now;
  for (Ending& one : unexecuted_) one.at = free_ = std::min(one.at, std::max(free_, one.arrived) + one.takes);
}

std::uint64_t Pace::executed(TimePoint now) {
  while (!unexecuted_.empty() && unexecuted_.front().at <= now) {
    executed_ = unexecuted_.front().end;
    unexecuted_.pop_front();
  }
  return executed_;
}

TimePoint Pace::when(std::uint64_t bytes) const {
  if (bytes <= executed_) return {};
  const auto found = std::ranges::lower_bound(unexecuted_, bytes, {}, &Ending::end);
  return found == unexecuted_.end() ? free_ : found->at;
}

}  // namespace axisgate::rml1
