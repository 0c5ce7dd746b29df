#include "server/watchdog.h"

#include <mutex>
#include <set>
#include <utility>

#include "server/log.h"

namespace axisgate::server {

class Watchdog::Rounds : public std::enable_shared_from_this<Rounds> {
 public:
  Rounds(std::vector<Thread> threads, Duration period, Later later, std::function<void()> alive)
      : threads_(std::move(threads)), period_(period), later_(std::move(later)), alive_(std::move(alive)) {}

  void ask() {
    const std::lock_guard asking(asking_);
    {
      const std::lock_guard lock(mutex_);
      if (ended_) return;
      for (std::size_t i = 0; i < threads_.size(); ++i) silent_.insert(i);
      named_ = false;
    }
    for (std::size_t i = 0; i < threads_.size(); ++i) {
      threads_[i].ask([rounds = weak_from_this(), i] {
        if (const auto still = rounds.lock()) still->answered(i);
      });
    }
    look_later();
  }

  void end() {
    const std::lock_guard asking(asking_);
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }

 private:
  void answered(std::size_t thread) {
    const std::lock_guard lock(mutex_);
    silent_.erase(thread);
  }

  void look() {
    {
      const std::lock_guard lock(mutex_);
      if (ended_) return;
      if (!silent_.empty()) {
        if (!std::exchange(named_, true)) {
          log::critical("{} does not answer: the service manager restarts the daemon if this lasts",
                        threads_[*silent_.begin()].name);
        }
        return look_later();
      }
      alive_();
    }
    ask();
  }

  void look_later() {
    later_(period_, [rounds = weak_from_this()] {
      if (const auto still = rounds.lock()) still->look();
    });
  }

  const std::vector<Thread> threads_;
  const Duration period_;
  const Later later_;
  const std::function<void()> alive_;

  std::mutex asking_;  // locked while the threads are asked; lock it before mutex_, which an answer locks
  std::mutex mutex_;
  std::set<std::size_t> silent_;  // indices of threads_ that have not answered the present question
  bool named_ = false;
  bool ended_ = false;
};

Watchdog::Watchdog(std::vector<Thread> threads, Duration period, Later later, std::function<void()> alive)
    : rounds_(std::make_shared<Rounds>(std::move(threads), period, std::move(later), std::move(alive))) {
  rounds_->ask();
}

Watchdog::~Watchdog() { rounds_->end(); }

}  // namespace axisgate::server
