// Newest value of something. Older values are dropped: a slow reader receives fewer values, but no delayed ones.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "server/events/wake_ups.h"

namespace axisgate::server {

// Thread safe.
template <class Value>
class Newest {
 public:
  explicit Newest(Executor executor) : newest_{std::make_shared<const Value>(), 0}, wake_ups_(std::move(executor)) {}

  struct Snapshot {
    std::shared_ptr<const Value> value;  // never null
    std::uint64_t version = 0;           // from 1; 0 before the first publish()
  };

  void publish(Value value) {
    auto shared = std::make_shared<const Value>(std::move(value));
    {
      const std::lock_guard lock(mutex_);
      newest_ = {std::move(shared), newest_.version + 1};
    }
    wake_ups_.wake_all();
  }

  Snapshot get() const {
    const std::lock_guard lock(mutex_);
    return newest_;
  }

  bool has_subscribers() const { return wake_ups_.has_subscribers(); }

  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake) {
    return wake_ups_.subscribe(std::move(wake));
  }

 private:
  mutable std::mutex mutex_;
  Snapshot newest_;
  WakeUps wake_ups_;
};

}  // namespace axisgate::server
