#include "server/events/event_bus.h"

#include <algorithm>
#include <utility>

namespace axisgate::server {

EventBus::EventBus(Executor executor, std::size_t facts_kept)
    : facts_kept_(facts_kept), wake_ups_(std::move(executor)) {}

std::uint64_t EventBus::publish(std::string device, Fact fact, WallTime time, Moment clock) {
  auto record = std::make_shared<FactRecord>(FactRecord{0, std::move(device), time, std::move(fact), clock});
  std::uint64_t revision = 0;
  {
    const std::lock_guard lock(mutex_);
    revision = record->revision = ++newest_;
    facts_.push_back(std::move(record));
    if (facts_.size() > facts_kept_) facts_.pop_front();
  }
  wake_ups_.wake_all();
  return revision;
}

std::uint64_t EventBus::newest_revision() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

EventBus::Reading EventBus::read(std::uint64_t from, std::size_t limit) const {
  const std::lock_guard lock(mutex_);
  const std::uint64_t oldest = newest_ - facts_.size() + 1;
  if (from == 0) from = oldest;
  if (from < oldest || from > newest_ + 1) return {{}, oldest, true};
  const auto begin = facts_.begin() + static_cast<std::ptrdiff_t>(from - oldest);
  const auto left = static_cast<std::size_t>(facts_.end() - begin);
  const auto end = begin + static_cast<std::ptrdiff_t>(std::min(limit, left));
  return {{begin, end}, from + static_cast<std::uint64_t>(end - begin), false};
}

std::unique_ptr<WakeUps::Subscription> EventBus::subscribe(std::function<void()> wake) {
  return wake_ups_.subscribe(std::move(wake));
}

}  // namespace axisgate::server
