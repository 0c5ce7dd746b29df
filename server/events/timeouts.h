// Tasks that are due later. All share one timer, so a task that is dropped before its time, like most of them, costs
// neither a timer nor a wake-up.
#pragma once

#include <functional>
#include <memory>

#include "device/core/time.h"
#include "device/link/asio.h"

namespace axisgate::server {

// A Timeout drops its task when it is destroyed. The task may be running by then.
class Timeout {
 public:
  virtual ~Timeout() = default;
};

// Thread safe.
class Timeouts {
 public:
  explicit Timeouts(boost::asio::io_context& context);
  // Drops the tasks that are not due yet.
  ~Timeouts();
  Timeouts(const Timeouts&) = delete;
  Timeouts& operator=(const Timeouts&) = delete;

  // Calls `task` once in the io_context after `wait`.
  void after(Duration wait, std::function<void()> task);
  // Does the same, unless the returned object is destroyed first.
  [[nodiscard]] std::unique_ptr<Timeout> unless_dropped(Duration wait, std::function<void()> task);

 private:
  class Queue;
  class Handle;

  const std::shared_ptr<Queue> queue_;
};

}  // namespace axisgate::server
