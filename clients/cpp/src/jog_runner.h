// A jog in progress, and the thread that renews it.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include "clients/cpp/src/session.h"

namespace axisgate::client {

class JogRunner {
 public:
  // Returns once the axes run. Throws Refused.
  JogRunner(std::shared_ptr<DeviceSession> session, const v1::JogRequest& first);
  // Stops the axes.
  ~JogRunner();
  JogRunner(const JogRunner&) = delete;
  JogRunner& operator=(const JogRunner&) = delete;

  const Motion& motion() const { return *motion_; }
  MotionResult stop();

 private:
  void send(const std::stop_token& ended, v1::JogRequest message, Clock::time_point start_limit);
  // Ends the renewals and the call.
  void end();

  const std::shared_ptr<DeviceSession> session_;
  grpc::ClientContext context_;
  const std::unique_ptr<grpc::ClientReaderWriter<v1::JogRequest, v1::JogResponse>> call_;
  std::atomic<bool> started_ = false;
  std::optional<Motion> motion_;
  std::jthread sender_;
};

}  // namespace axisgate::client
