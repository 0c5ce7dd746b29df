// Motions with one request and one answer; and what became of any motion.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/stage_controller.h"
#include "server/api/request/call.h"
#include "server/api/request/motion_watch.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/streams.h"
#include "server/api/stage/targets.h"
#include "server/gateway.h"

namespace axisgate::api {

// Thread safe. Each answers with what kept it from starting, or when it has started: with the problems of
// Pipeline::admit(), of Permission, and of the device.
class Motions {
 public:
  // All outlive this.
  Motions(server::Gateway& gateway, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}

  void move(const Call& call, std::string_view device, Result<Move> move, Answer<StartedMotion> answer) const;
  // Of no axes named, all. unknown_axis, link_down.
  void home(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
            Answer<StartedMotion> answer) const;
  void return_to_origin(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                        Answer<StartedMotion> answer) const;
  // The context in `scan` is filled in here.
  void scan(const Call& call, std::string_view device, Result<stage::ScanRequest> scan,
            Answer<StartedMotion> answer) const;

  // not_found.
  void get(const Call& call, std::string_view motion, Answer<CurrentMotion> answer) const;
  // Oldest first.
  void list(const Call& call, std::string_view device, Answer<std::vector<CurrentMotion>> answer) const;
  // The motion now and at every change, until its outcome; a slow reader sees fewer changes. Ends with not_found.
  Opened<CurrentMotion> watch(const Call& call, std::string_view motion) const;
  // Needs no lease, as a stop. not_found.
  void cancel(const Call& call, std::string_view motion, Answer<void> answer) const;

 private:
  using Start = void (stage::StageController::*)(stage::HomeRequest, TimePoint, stage::StageController::OnStarted);
  void begin_home(RequestKind kind, Start start, const Call& call, std::string_view device,
                  const Result<stage::AxisSet>& axes, Answer<StartedMotion> answer) const;

  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

// Answers with the motion, or with what kept it from starting.
stage::StageController::OnStarted answering(server::Stage& device, Answer<StartedMotion> answer);

}  // namespace axisgate::api
