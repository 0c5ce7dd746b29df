#include "device/rml1/sending/pace.h"

#include <algorithm>
#include <chrono>

namespace axisgate::rml1 {

void Pace::arrived(std::uint64_t through, TimePoint at) {
  const auto& steps = timeline_.steps();
  free_ = std::max(free_, at);
  while (next_ < steps.size() && steps[next_].end <= through) {
    const std::chrono::duration<double> takes(steps[next_].*duration_ * slower_);
    free_ += std::chrono::duration_cast<Duration>(takes);
    add(steps[next_++].end);
  }
  // What moves nothing is over with what was before it.
  add(through);
}

// A command with several steps has been executed when the last has ended.
void Pace::add(std::uint64_t end) {
  if (under_way_.empty() || under_way_.back().end != end) under_way_.push_back({end, {}});
  under_way_.back().at = free_;
}

std::uint64_t Pace::executed(TimePoint now) {
  while (!under_way_.empty() && under_way_.front().at <= now) {
    executed_ = under_way_.front().end;
    under_way_.pop_front();
  }
  return executed_;
}

TimePoint Pace::when(std::uint64_t bytes) const {
  if (bytes <= executed_) return {};
  const auto found = std::ranges::lower_bound(under_way_, bytes, {}, &Ending::end);
  return found == under_way_.end() ? free_ : found->at;
}

}  // namespace axisgate::rml1
