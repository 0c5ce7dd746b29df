// The newest state of one device. Older ones are forgotten: a slow reader sees fewer, never later ones.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include "device/shrc203/state.h"
#include "server/events/wake_ups.h"

namespace axisgate::server {

// Thread safe.
class NewestState {
 public:
  explicit NewestState(Executor executor);

  struct Snapshot {
    std::shared_ptr<const shrc203::State> state;  // never null
    std::uint64_t version = 0;                    // counts from 1; 0 before the first
  };

  void publish(shrc203::State state);
  Snapshot get() const;
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake);

 private:
  mutable std::mutex mutex_;
  Snapshot newest_;
  WakeUps wake_ups_;
};

}  // namespace axisgate::server
