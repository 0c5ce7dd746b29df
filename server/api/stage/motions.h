// Motions with one request and one answer, and queries of all motions.
#pragma once

#include <functional>
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

// Thread safe. Each answers when the motion has started, or with the problem that kept it from starting: those of
// Pipeline::admit(), of Permission, and of the device.
class Motions {
 public:
  // The referenced objects must outlive this one.
  Motions(server::Gateway& gateway, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}

  void move(const Call& call, std::string_view device, Result<Move> move, Answer<StartedMotion> answer) const;
  // Homes the axes; empty: all. Fails with unknown_axis or link_down.
  void home(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
            Answer<StartedMotion> answer) const;
  void return_to_origin(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                        Answer<StartedMotion> answer) const;
  void scan(const Call& call, std::string_view device, Result<Scan> scan, Answer<StartedMotion> answer) const;

  // Fails with not_found.
  void get(const Call& call, std::string_view motion, Answer<CurrentMotion> answer) const;
  // Returns the oldest motion first.
  void list(const Call& call, std::string_view device, Answer<std::vector<CurrentMotion>> answer) const;
  // Streams the motion now and at every change, until its outcome; a slow reader sees fewer changes. Ends with
  // not_found if there is no such motion.
  Opened<CurrentMotion> watch(const Call& call, std::string_view motion) const;
  // Answers when the motion has its outcome, or after `longest` with its present state. Returns a function to call if
  // the caller leaves; null if the request was refused. Fails with not_found.
  std::function<void()> wait(const Call& call, std::string_view motion, Duration longest,
                             const Answer<CurrentMotion>& answer) const;
  // Needs no lease, like a stop. Fails with not_found.
  void cancel(const Call& call, std::string_view motion, Answer<void> answer) const;

 private:
  Opened<CurrentMotion> open(RequestKind kind, const Call& call, std::string_view motion) const;

  using Start = void (stage::StageController::*)(stage::HomeRequest, TimePoint, stage::StageController::OnStarted);
  void begin_home(RequestKind kind, Start start, const Call& call, std::string_view device,
                  const Result<stage::AxisSet>& axes, Answer<StartedMotion> answer) const;

  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

// Returns a callback that answers with the motion, or with the problem that kept it from starting.
stage::StageController::OnStarted answering(server::Stage& device, Answer<StartedMotion> answer);

}  // namespace axisgate::api
