// Jogs: axes that run for as long as their caller requests it.
#pragma once

#include <cstdint>
#include <functional>
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
#include "server/api/stage/jog_numbers.h"
#include "server/gateway.h"

namespace axisgate::api {

struct JogAxis {
  int axis = 0;                     // from 1
  std::optional<int> direction{};   // 1 or -1; used by start() only
  std::optional<Quantity> speed{};  // per second; nullopt: the axis's own speed
};

// A Jog receives the messages of one jog, and its reader receives the motion at every change. Messages take effect when
// they arrive, whether or not the reader reads. Thread safe.
class Jog final : public MotionSubscription {
 public:
  // The referenced objects must outlive this one.
  Jog(server::Gateway& gateway, const Pipeline& pipeline, Streams::Place place)
      : MotionSubscription(gateway, std::move(place)), pipeline_(pipeline) {}

  // Handles the first message. Returns false if the message was refused: the stream ends with the problem, and later
  // messages have no effect.
  bool start(const Call& call, std::string_view device, const Result<std::vector<JogAxis>>& axes);
  // Handles a later message: the jog continues, with the new speeds of `axes`. Returns false if the message was
  // refused: the jog is stopped, and the stream ends with the problem.
  bool renew(const Result<std::vector<JogAxis>>& axes);

  // Handles an invalid message: ends the stream with `problem`, and stops the jog.
  void refuse_part(const Problem& problem) { (void)refuse(problem); }

  // Ends the jog at the caller's request.
  void finish();
  // Stops the jog after the caller has disconnected without ending it.
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

  // Used on the device's strand.
  stage::MotionId motion_ = 0;  // 0: none
  bool over_ = false;           // the caller no longer wants motion
};

// A KeptJog is the answer to a message that keeps a jog running.
struct KeptJog {
  CurrentMotion motion;
  bool extended = false;  // the message counted
};

// Thread safe.
class Jogs {
 public:
  // The referenced objects must outlive this one.
  Jogs(server::Gateway& gateway, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}

  // Fails with queue_full.
  Result<std::shared_ptr<Jog>> open(const Credential& caller) const;

  // The three below are for callers that cannot stream. Answers once the axes run; until then the caller cannot renew
  // the jog and need not. Returns a function to call if the caller leaves before; null if the request was refused.
  std::function<void()> start(const Call& call, std::string_view device, const Result<std::vector<JogAxis>>& axes,
                              const Answer<StartedMotion>& answer) const;
  // Lets the jog run on if `number` is higher than all before it. A refused message stops the axes. Fails with
  // not_found, invalid_request if the motion is no jog, and not_allowed if it is another caller's.
  void keep(const Call& call, std::string_view motion, std::int64_t number, const Result<std::vector<JogAxis>>& axes,
            Answer<KeptJog> answer) const;
  // Ends the jog at its caller's request. Fails as keep() does.
  void stop(const Call& call, std::string_view motion, Answer<CurrentMotion> answer) const;

 private:
  // Calls `act` on the strand with the jog, if it is the caller's.
  template <class Outcome, class Act>
  void on_jog(RequestKind kind, const Call& call, std::string_view motion, Answer<Outcome> answer, Act act) const;

  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  Streams& streams_;
  const std::shared_ptr<JogNumbers> numbers_ = std::make_shared<JogNumbers>();  // also of what is still posted
};

}  // namespace axisgate::api
