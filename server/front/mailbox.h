// By this a reply reaches the front from whichever thread, or nobody once the front has gone.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "device/link/asio.h"

namespace axisgate::front {

// Thread safe.
class Mailbox {
 public:
  explicit Mailbox(Strand strand) : strand_(std::move(strand)) {}

  void post(std::function<void()> task) {
    const std::lock_guard lock(mutex_);
    if (strand_) boost::asio::post(*strand_, std::move(task));
  }
  // From now on what is posted is dropped.
  void close() {
    const std::lock_guard lock(mutex_);
    strand_.reset();
  }

 private:
  std::mutex mutex_;
  std::optional<Strand> strand_;
};

}  // namespace axisgate::front
