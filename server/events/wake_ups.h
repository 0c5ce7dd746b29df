// Notifications of waiting readers about changes, on another thread than the one that made the change.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace axisgate::server {

// An Executor runs a task later, on a thread that is not the caller's; tasks run one after the other.
using Executor = std::function<void(std::function<void()>)>;

// Thread safe. Any number of wake_all() calls before the executor runs cause one round of wake-ups. So a thousand
// readers cost the device's strand one task, and no readers cost it nothing.
class WakeUps {
 public:
  explicit WakeUps(Executor executor);

  // Calls `wake` on the executor after each wake_all() while the Subscription exists. The destructor waits for a call
  // in progress, unless it runs within that call, and no call comes after it.
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
