#include "server/events/event_bus.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace axisgate::server {
namespace {

// Returns the motion whose state the fact describes; 0 if there is none.
stage::MotionId motion_of(const FactRecord& record) {
  const auto* change = std::get_if<stage::MotionChanged>(&record.fact);
  return change == nullptr ? 0 : change->motion.id;
}

}  // namespace

EventBus::EventBus(Executor executor, std::string run, FactsBefore before, Keep keep, std::size_t facts_kept)
    : run_(std::move(run)), keep_(std::move(keep)), facts_kept_(facts_kept), wake_ups_(std::move(executor)) {
  for (FactPointer& record : before.facts) add(std::move(record));
  newest_ = before.first - 1;
}

std::uint64_t EventBus::publish(std::string device, Fact fact, WallTime time, Moment clock) {
  // The journal's file stores microseconds, so the time is the same after a restart.
  const auto rounded = std::chrono::floor<std::chrono::microseconds>(time);
  auto record = std::make_shared<FactRecord>(FactRecord{0, std::move(device), rounded, std::move(fact), clock, run_});
  std::uint64_t revision = 0;
  {
    const std::lock_guard lock(mutex_);
    revision = record->revision = ++newest_;
    add(record);
    if (keep_) keep_(std::move(record), oldest());
  }
  wake_ups_.wake_all();
  return revision;
}

void EventBus::add(FactPointer record) {
  if (const stage::MotionId motion = motion_of(*record); motion != 0) motions_[{record->device, motion}] = record;
  facts_.push_back(std::move(record));
  if (facts_.size() > facts_kept_) forget_oldest();
}

void EventBus::forget_oldest() {
  const FactPointer gone = std::move(facts_.front());
  facts_.pop_front();
  const auto about = motions_.find({gone->device, motion_of(*gone)});
  if (about != motions_.end() && about->second == gone) motions_.erase(about);
}

std::uint64_t EventBus::newest_revision() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

EventBus::Facts::const_iterator EventBus::find(std::uint64_t revision) const {
  return std::ranges::lower_bound(facts_, revision, {}, [](const FactPointer& record) { return record->revision; });
}

EventBus::Reading EventBus::read(std::uint64_t from, std::size_t limit) const {
  const std::lock_guard lock(mutex_);
  if (from == 0) from = oldest();
  if (from < oldest() || from > newest_ + 1) return {{}, oldest(), true};
  const auto begin = find(from);
  const auto left = static_cast<std::size_t>(facts_.end() - begin);
  const auto end = begin + static_cast<std::ptrdiff_t>(std::min(limit, left));
  return {{begin, end}, begin == end ? from : (*std::prev(end))->revision + 1, false};
}

bool EventBus::resumes(std::string_view run, std::uint64_t from) const {
  const std::lock_guard lock(mutex_);
  const auto first = find(from);
  return (first != facts_.end() && (*first)->run == run) ||
         (first != facts_.begin() && (*std::prev(first))->run == run);
}

FactPointer EventBus::find_motion(const std::string& device, stage::MotionId motion) const {
  const std::lock_guard lock(mutex_);
  const auto found = motions_.find({device, motion});
  return found == motions_.end() ? nullptr : found->second;
}

std::vector<FactPointer> EventBus::open_motions() const {
  const std::lock_guard lock(mutex_);
  std::vector<FactPointer> open;
  for (const auto& [name, record] : motions_) {
    if (!stage::is_outcome(std::get<stage::MotionChanged>(record->fact).motion.state)) open.push_back(record);
  }
  return open;
}

std::unique_ptr<WakeUps::Subscription> EventBus::subscribe(std::function<void()> wake) {
  return wake_ups_.subscribe(std::move(wake));
}

}  // namespace axisgate::server
