#include "axisgate/jog.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "clients/cpp/src/jog_runner.h"

namespace axisgate {
namespace client {
namespace {

// Interval of the renewals. The daemon stops the axes after 500 ms without a renewal.
constexpr milliseconds kRenewEvery{100};

}  // namespace

JogRunner::JogRunner(std::shared_ptr<DeviceSession> session, const v1::JogRequest& first)
    : session_(std::move(session)), call_(session_->services().stage.Jog(&context_)) {
  sender_ = std::jthread([this, first, limit = Clock::now() + 2 * session_->connection().half()](
                             const std::stop_token& ended) { send(ended, first, limit); });
  v1::JogResponse response;
  if (call_->Read(&response)) {
    started_ = true;
    motion_ = session_->to_motion(response.motion());
    return;
  }
  sender_.request_stop();
  sender_.join();
  throw_error(Failure(call_->Finish()), session_->connection().address());
}

JogRunner::~JogRunner() { end(); }

MotionResult JogRunner::stop() {
  end();
  return motion_->wait();
}

void JogRunner::end() {
  if (!sender_.joinable()) return;
  sender_.request_stop();
  sender_.join();
  v1::JogResponse response;
  while (call_->Read(&response)) continue;
  (void)call_->Finish();  // the outcome of the motion says more
}

void JogRunner::send(const std::stop_token& ended, v1::JogRequest message, Clock::time_point start_limit) {
  std::mutex mutex;
  std::condition_variable_any waiting;
  while (call_->Write(message)) {
    message = v1::JogRequest();
    std::unique_lock lock(mutex);
    waiting.wait_for(lock, ended, kRenewEvery, [] { return false; });
    if (ended.stop_requested()) {
      call_->WritesDone();
      return;
    }
    if (!started_ && Clock::now() > start_limit) context_.TryCancel();
  }
}

}  // namespace client

Jog::Jog(std::unique_ptr<client::JogRunner> runner) : runner_(std::move(runner)) {}
Jog::~Jog() = default;
Jog::Jog(Jog&&) noexcept = default;

Motion Jog::motion() const { return runner_->motion(); }

MotionResult Jog::stop() { return runner_->stop(); }

}  // namespace axisgate
