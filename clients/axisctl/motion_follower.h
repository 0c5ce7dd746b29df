// Shows a motion on its way: every event of it in order, and the positions.
#pragma once

#include <grpcpp/grpcpp.h>

#include <future>
#include <memory>
#include <string>
#include <thread>

#include "clients/axisctl/live_display.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Made before the motion is requested, so that none of its events is missed. It only shows events. Its caller learns
// from the daemon's answer whether the motion succeeded, and a follower that loses its streams says nothing about that.
class MotionFollower {
 public:
  MotionFollower(const Session& session, const v1::Device& device);
  ~MotionFollower();

  // From now on the events of `motion` are shown, those that have come already first.
  void follow(const std::string& motion);

  // The motion has its outcome: waits, at most a second, until its last event is shown, and ends.
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
