#include "device/core/task.h"

namespace axisgate {

void Executor::spawn(Task<void> task) {
  task.handle().promise().spawned = {next_number_, &ended_};
  post(task.handle());
  tasks_.emplace(next_number_++, std::move(task));
}

void Executor::run() {
  if (running_) return;  // a callback of a task requested another run; the loop below resumes its tasks, too
  running_ = true;
  for (std::size_t next = 0; next < ready_.size(); ++next) {
    const auto handle = ready_[next];
    handle.resume();
  }
  ready_.clear();
  running_ = false;
  for (const std::uint64_t number : std::exchange(ended_, {})) tasks_.erase(number);
}

void Executor::advance(TimePoint now) {
  while (!deadlines_.empty() && deadlines_.begin()->first <= now) {
    auto waiter = deadlines_.extract(deadlines_.begin()).mapped().lock();
    if (waiter) waiter->timed_out();
  }
}

std::optional<TimePoint> Executor::next_deadline() const {
  // A waiter that is gone costs only one early wake-up.
  if (deadlines_.empty()) return {};
  return deadlines_.begin()->first;
}

struct Signal::Entry : Executor::Waiter {
  explicit Entry(Executor& executor) : shot(executor) {}
  void timed_out() override { shot.deliver(false); }
  OneShot<bool> shot;
};

void Signal::notify() {
  for (const auto& entry : std::exchange(waiting_, {})) entry->shot.deliver(true);
}

OneShot<bool> Signal::wait_until(TimePoint deadline) {
  std::erase_if(waiting_, [](const auto& entry) { return entry->shot.delivered(); });
  auto entry = std::make_shared<Entry>(executor_);
  waiting_.push_back(entry);
  executor_.at(deadline, entry);
  return entry->shot;
}

}  // namespace axisgate
