#include "axisgate/motion.h"

#include <algorithm>
#include <utility>

#include "clients/cpp/src/motion_handle.h"
#include "clients/cpp/src/outcomes.h"

namespace axisgate {
namespace client {

v1::Motion MotionHandle::message() const {
  const std::lock_guard lock(mutex_);
  return message_;
}

void MotionHandle::follow(Clock::time_point end, std::stop_token stop) {
  v1::Motion motion = session_->connection().follow(message(), end, std::move(stop));
  const std::lock_guard lock(mutex_);
  if (!is_over(message_)) message_ = std::move(motion);
}

}  // namespace client

using client::Clock;

std::string Motion::name() const { return handle_->message().name(); }

std::string Motion::state() const { return client::state_name(handle_->message().state()); }

std::string Motion::request_id() const { return handle_->message().request_id(); }

bool Motion::done() const {
  handle_->follow(Clock::now());
  return client::is_over(handle_->message());
}

MotionResult Motion::wait(std::stop_token stop) const {
  handle_->follow(Clock::time_point::max(), std::move(stop));
  return client::outcome_of(handle_->message());
}

std::optional<MotionResult> Motion::wait_for(std::chrono::milliseconds limit) const {
  handle_->follow(Clock::now() + limit);
  const v1::Motion motion = handle_->message();
  return client::is_over(motion) ? std::optional(client::outcome_of(motion)) : std::nullopt;
}

void Motion::follow(const std::function<void(const Progress&)>& show, std::chrono::milliseconds interval) const {
  std::optional<v1::Device> first;
  while (true) {
    handle_->follow(Clock::now() + interval);
    const v1::Motion motion = handle_->message();
    if (client::is_over(motion)) return;
    const v1::Device now = handle_->session().read(std::nullopt);
    if (!first) first = now;
    show(client::progress_of(motion, *first, now));
  }
}

void Motion::cancel() const {
  client::DeviceSession& session = handle_->session();
  v1::CancelMotionRequest request;
  request.set_motion(name());
  session.act(session.services().stage, &v1::StageService::Stub::CancelMotion, request);
}

}  // namespace axisgate
