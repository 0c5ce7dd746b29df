#include "server/events/wake_ups.h"

#include <algorithm>
#include <utility>

namespace axisgate::server {

class WakeUps::Sleeper {
 public:
  explicit Sleeper(std::function<void()> wake) : wake_(std::move(wake)) {}

  void wake() {
    const std::lock_guard lock(mutex_);
    if (awake_) wake_();
  }

  void leave() {
    const std::lock_guard lock(mutex_);
    awake_ = false;
  }

 private:
  std::recursive_mutex mutex_;  // a reader may unsubscribe within its own wake-up
  bool awake_ = true;
  const std::function<void()> wake_;
};

class WakeUps::Handle final : public Subscription {
 public:
  Handle(std::shared_ptr<Shared> shared, std::shared_ptr<Sleeper> sleeper)
      : shared_(std::move(shared)), sleeper_(std::move(sleeper)) {}

  ~Handle() override {
    {
      const std::lock_guard lock(shared_->mutex);
      std::erase(shared_->sleepers, sleeper_);
    }
    sleeper_->leave();
  }

 private:
  std::shared_ptr<Shared> shared_;
  std::shared_ptr<Sleeper> sleeper_;
};

WakeUps::WakeUps(Executor executor) : executor_(std::move(executor)), shared_(std::make_shared<Shared>()) {}

std::unique_ptr<WakeUps::Subscription> WakeUps::subscribe(std::function<void()> wake) {
  auto sleeper = std::make_shared<Sleeper>(std::move(wake));
  const std::lock_guard lock(shared_->mutex);
  shared_->sleepers.push_back(sleeper);
  return std::make_unique<Handle>(shared_, std::move(sleeper));
}

bool WakeUps::has_subscribers() const {
  const std::lock_guard lock(shared_->mutex);
  return !shared_->sleepers.empty();
}

void WakeUps::wake_all() {
  if (!has_subscribers()) return;
  if (shared_->due.exchange(true)) return;
  executor_([shared = shared_] { run(*shared); });
}

void WakeUps::run(Shared& shared) {
  // Cleared before the list is read, so that later changes cause another round.
  shared.due = false;
  std::vector<std::shared_ptr<Sleeper>> sleepers;
  {
    const std::lock_guard lock(shared.mutex);
    sleepers = shared.sleepers;
  }
  for (const auto& sleeper : sleepers) sleeper->wake();
}

}  // namespace axisgate::server
