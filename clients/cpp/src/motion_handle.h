// The shared state of all copies of one Motion.
#pragma once

#include <memory>
#include <mutex>

#include "clients/cpp/src/session.h"

namespace axisgate::client {

class MotionHandle {
 public:
  MotionHandle(std::shared_ptr<DeviceSession> session, v1::Motion message)
      : session_(std::move(session)), message_(std::move(message)) {}

  DeviceSession& session() const { return *session_; }
  v1::Motion message() const;
  // Waits for the outcome until `end`. Throws OutcomeUnknown, and Interrupted after `stop`.
  void follow(Clock::time_point end, std::stop_token stop = {});

 private:
  const std::shared_ptr<DeviceSession> session_;
  mutable std::mutex mutex_;
  v1::Motion message_;
};

}  // namespace axisgate::client
