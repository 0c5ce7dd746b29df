#include "device/link/line_thread.h"

#include "device/link/clock.h"

namespace axisgate {
namespace {

// Limit for a prompt reply: two bytes take longer at 115200 baud.
constexpr Duration kPromptReply = std::chrono::microseconds(150);
// Time that an instant device needs for a reply, and a client on the same machine between two questions.
constexpr Duration kAwake = std::chrono::microseconds(100);

}  // namespace

void Wakefulness::written(TimePoint now) {
  written_ = now;
  if (device_is_prompt_) until_ = now + kAwake;
}

void Wakefulness::replied(TimePoint now) {
  if (!written_) return;
  device_is_prompt_ = now - *written_ <= kPromptReply;
  written_.reset();
  if (device_is_prompt_) until_ = now + kAwake;
}

void LineThread::start() {
  thread_ = std::thread([this] { run(); });
}

void LineThread::stop() {
  work_.reset();
  context_.stop();
  if (thread_.joinable()) thread_.join();
}

void LineThread::run() {
  // On a single processor the other threads could not run while this one stays awake.
  const bool may_stay_awake = std::thread::hardware_concurrency() > 1;
  while (!context_.stopped()) {
    if (may_stay_awake && wakefulness_.is_awake(monotonic_now())) {
      context_.poll();
    } else {
      context_.run_one();
    }
  }
}

}  // namespace axisgate
