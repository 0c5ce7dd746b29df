#include "server/events/newest_state.h"

#include <utility>

namespace axisgate::server {

NewestState::NewestState(Executor executor)
    : newest_{std::make_shared<const shrc203::State>(), 0}, wake_ups_(std::move(executor)) {}

void NewestState::publish(shrc203::State state) {
  auto shared = std::make_shared<const shrc203::State>(std::move(state));
  {
    const std::lock_guard lock(mutex_);
    newest_ = {std::move(shared), newest_.version + 1};
  }
  wake_ups_.wake_all();
}

NewestState::Snapshot NewestState::get() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::unique_ptr<WakeUps::Subscription> NewestState::subscribe(std::function<void()> wake) {
  return wake_ups_.subscribe(std::move(wake));
}

}  // namespace axisgate::server
