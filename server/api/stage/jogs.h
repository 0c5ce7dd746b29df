// Jogs: axes run for as long as their caller says so.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/stage/stage_controller.h"
#include "server/api/request/call.h"
#include "server/api/request/motion_watch.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/streams.h"
#include "server/gateway.h"

namespace axisgate::api {

struct JogAxis {
  int axis = 0;                     // 1 to 3
  std::optional<int> direction{};   // 1 or -1; counts in start() only
  std::optional<Quantity> speed{};  // per second; nothing: the axis's own
};

// One jog: its messages are taken in here, and its reader receives the motion at every change. Messages count as they
// come, whether the reader reads or not. Thread safe.
class Jog final : public MotionSubscription {
 public:
  // Both outlive this.
  Jog(server::Gateway& gateway, const Pipeline& pipeline, Streams::Place place)
      : MotionSubscription(gateway, std::move(place)), pipeline_(pipeline) {}

  // The first message. False: it was refused, the stream ends with the problem, and no message counts any more.
  bool start(const Call& call, std::string_view device, const Result<std::vector<JogAxis>>& axes);
  // Every other message: the jog continues, for `axes` at other speeds. False: the jog is stopped, and so on.
  bool renew(const Result<std::vector<JogAxis>>& axes);

  // What came is no message of a jog: the stream ends with `problem`, and the jog is stopped.
  void refuse_part(const Problem& problem) { (void)refuse(problem); }

  // The caller wants it to end.
  void finish();
  // The caller has gone without a word.
  void break_off() override;

 private:
  Result<void> post_renewal(server::Stage& device, const Result<std::vector<JogAxis>>& axes);
  bool is_over();
  void begin_on(const Turn& turn, const std::vector<JogAxis>& axes, const MutationPtr& mutation);
  void repeat(server::Stage& device, const Result<Known>& known);
  bool refuse(const Problem& problem);
  void stop(std::optional<Problem> why);
  server::Stage* device();

  const Pipeline& pipeline_;
  server::Stage* jogged_ = nullptr;            // under mutex_; null: no message yet
  bool broken_off_ = false, refused_ = false;  // under mutex_

  // On the device's strand.
  stage::MotionId motion_ = 0;  // 0: none
  bool over_ = false;           // the caller wants no motion any more
};

// Thread safe.
class Jogs {
 public:
  // All outlive this.
  Jogs(server::Gateway& gateway, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}

  // queue_full.
  Result<std::shared_ptr<Jog>> open(const Credential& caller) const;

 private:
  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
