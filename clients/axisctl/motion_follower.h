// Display of a running motion: its events in order, and the positions.
#pragma once

#include <grpcpp/grpcpp.h>

#include <future>
#include <memory>
#include <string>
#include <thread>

#include "clients/axisctl/live_display.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// A MotionFollower shows the events of a motion. Create it before the motion is requested, so that no event is missed.
// It does not report the outcome: the caller takes that from the daemon's answer, and a follower that loses its streams
// says nothing about it.
class MotionFollower {
 public:
  MotionFollower(const Session& session, const v1::Device& device);
  ~MotionFollower();

  // Starts to show the events of `motion`, beginning with those that have already arrived.
  void follow(const std::string& motion);

  // Waits at most a second until the motion's last event is shown, and ends the display. Call it when the motion has
  // its outcome.
  void finish();

 private:
  void show_events(const std::string& motion, std::promise<void> all_shown);
  void show_positions();

  const Session& session_;
  const std::string device_;
  grpc::ClientContext events_context_, positions_context_;
  std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> events_;
  std::future<void> all_shown_;
  LiveDisplay display_;
  std::thread events_thread_, positions_thread_;
};

}  // namespace axisgate::axisctl
