// Notifies waiting readers that there is something new, on another thread than the one that made it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace axisgate::server {

// Runs a task later, on a thread that is not the caller's; tasks run one after the other.
using Executor = std::function<void(std::function<void()>)>;

// Thread safe. Any number of wake_all() calls before the executor comes round cost one round of wake-ups, so that a
// thousand readers cost the device's strand one task; and none costs it nothing.
class WakeUps {
 public:
  explicit WakeUps(Executor executor);

  // While it lives, `wake` is called on the executor after each wake_all(). The destructor waits for a call under way
  // unless it is that call, and none comes after it.
  class Subscription {
   public:
    virtual ~Subscription() = default;
  };
  std::unique_ptr<Subscription> subscribe(std::function<void()> wake);

  void wake_all();
  bool has_subscribers() const;

 private:
  class Sleeper;
  class Handle;
  struct Shared {
    std::mutex mutex;
    std::vector<std::shared_ptr<Sleeper>> sleepers;
    std::atomic<bool> due = false;
  };

  static void run(Shared& shared);

  Executor executor_;
  std::shared_ptr<Shared> shared_;
};

}  // namespace axisgate::server
