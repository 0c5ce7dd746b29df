// Tasks that are due at a time to come. All share one timer, so a task that is dropped before its time costs neither a
// timer nor a wake-up: most are.
#pragma once

#include <functional>
#include <memory>

#include "device/core/time.h"
#include "device/link/asio.h"

namespace axisgate::server {

// Drops its task when it goes. The task may be under way by then.
class Timeout {
 public:
  virtual ~Timeout() = default;
};

// Thread safe.
class Timeouts {
 public:
  explicit Timeouts(boost::asio::io_context& context);
  // Tasks that are not due yet are dropped.
  ~Timeouts();
  Timeouts(const Timeouts&) = delete;
  Timeouts& operator=(const Timeouts&) = delete;

  // Calls `task` once in the io_context when `wait` is over.
  void after(Duration wait, std::function<void()> task);
  // The same, unless what it returns goes before.
  [[nodiscard]] std::unique_ptr<Timeout> unless_dropped(Duration wait, std::function<void()> task);

 private:
  class Queue;
  class Handle;

  const std::shared_ptr<Queue> queue_;
};

}  // namespace axisgate::server
