#include "server/events/timeouts.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "device/link/clock.h"

namespace axisgate::server {

class Timeouts::Queue : public std::enable_shared_from_this<Queue> {
 public:
  using Key = std::pair<TimePoint, std::uint64_t>;  // due time; the number distinguishes tasks of the same time

  explicit Queue(boost::asio::io_context& context) : timer_(context) {}

  Key add(Duration wait, std::function<void()> task) {
    const std::lock_guard lock(mutex_);
    const Key key{monotonic_now() + wait, next_++};
    tasks_.emplace(key, std::move(task));
    arm();
    return key;
  }

  // Destroys the task without the lock, because the objects that it owns may drop other tasks.
  void drop(const Key& key) {
    Tasks::node_type task;
    const std::lock_guard lock(mutex_);
    task = tasks_.extract(key);
  }

  void drop_all() {
    Tasks all;
    const std::lock_guard lock(mutex_);
    all.swap(tasks_);
    timer_.cancel();
  }

 private:
  using Tasks = std::map<Key, std::function<void()>>;

  // Keeps a timer that fires earlier: arm() runs again after it.
  void arm() {
    if (tasks_.empty() || (armed_ && *armed_ <= tasks_.begin()->first.first)) return;
    armed_ = tasks_.begin()->first.first;
    // Asio's clock stops while the host sleeps; monotonic_now() does not.
    timer_.expires_after(*armed_ - monotonic_now());
    timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
      if (!error) self->run_due();
    });
  }

  void run_due() {
    std::vector<std::function<void()>> due;
    {
      const std::lock_guard lock(mutex_);
      armed_.reset();
      for (const TimePoint now = monotonic_now(); !tasks_.empty() && tasks_.begin()->first.first <= now;) {
        due.push_back(std::move(tasks_.begin()->second));
        tasks_.erase(tasks_.begin());
      }
      arm();
    }
    for (const auto& task : due) task();
  }

  std::mutex mutex_;
  boost::asio::steady_timer timer_;
  std::optional<TimePoint> armed_;
  std::uint64_t next_ = 0;
  Tasks tasks_;
};

class Timeouts::Handle final : public Timeout {
 public:
  Handle(std::shared_ptr<Queue> queue, Queue::Key key) : queue_(std::move(queue)), key_(key) {}
  ~Handle() override { queue_->drop(key_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

 private:
  const std::shared_ptr<Queue> queue_;
  const Queue::Key key_;
};

Timeouts::Timeouts(boost::asio::io_context& context) : queue_(std::make_shared<Queue>(context)) {}

Timeouts::~Timeouts() { queue_->drop_all(); }

void Timeouts::after(Duration wait, std::function<void()> task) { (void)queue_->add(wait, std::move(task)); }

std::unique_ptr<Timeout> Timeouts::unless_dropped(Duration wait, std::function<void()> task) {
  return std::make_unique<Handle>(queue_, queue_->add(wait, std::move(task)));
}

}  // namespace axisgate::server
