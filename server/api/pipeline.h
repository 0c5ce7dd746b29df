// The way of every request to a device but a stop: role, device, context; on the device's strand the right to all axes,
// the request's own checks, and then either the answer to validate_only or the operation itself.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "device/core/problem.h"
#include "device/stage/stage_controller.h"
#include "server/api/admission.h"
#include "server/api/call.h"
#include "server/api/request_kinds.h"
#include "server/devices/stage.h"

namespace axisgate::api {

// A request that was let in.
struct Admitted {
  server::Stage* device = nullptr;  // never null
  server::Caller caller;
  stage::RequestContext context;
};

// Such a request on its device's strand.
struct Turn {
  server::Stage& device;
  stage::StageController& controller;
  const server::Caller& caller;
  const stage::RequestContext& context;
  TimePoint now;
};

// What a door hands in.
struct Asked {
  RequestKind kind;
  const Call& call;                // copied as far as it is needed
  Result<server::Stage*> device;   // or why there is none
  std::optional<Problem> fault{};  // of how the rest is written
};

// deadline_passed for what would start a motion after its not_after: while it was posted, its time ran out. What waits
// on the device longer than that is refused there.
Result<void> check_deadline(RequestKind kind, const stage::RequestContext& context, TimePoint now);

// Thread safe.
class Pipeline {
 public:
  // It outlives this.
  explicit Pipeline(const Admission& admission) : admission_(admission) {}

  // In this order: unauthenticated, not_allowed; invalid_request or unknown_device; invalid_request for a request_id;
  // the fault of the rest.
  Result<Admitted> admit(const Asked& asked) const;

  // Posts to the device. There `prepare` makes what is to be done of the request and the device's state, or refuses;
  // `check` does the rest of the checks where validate_only ends the request there; `begin` does it and answers.
  //   Result<Prepared> prepare(const Turn&)
  //   Result<void> check(const Turn&, const Prepared&)
  //   void begin(const Turn&, Prepared, const Answer<Outcome>&)
  // The answer to validate_only is an empty Outcome.
  template <class Outcome, class Prepare, class Check, class Begin>
  void run(const Asked& asked, Answer<Outcome> answer, Prepare prepare, Check check, Begin begin) const;

  // Likewise, for what has nothing to check there, and no validate_only.
  //   void begin(const Turn&, const Answer<Outcome>&)
  template <class Outcome, class Begin>
  void ask(const Asked& asked, Answer<Outcome> answer, Begin begin) const;

 private:
  static Result<void> check_right(RequestKind kind, const Turn& turn);

  const Admission& admission_;
};

template <class Outcome, class Prepare, class Check, class Begin>
void Pipeline::run(const Asked& asked, Answer<Outcome> answer, Prepare prepare, Check check, Begin begin) const {
  ask(asked, std::move(answer),
      [kind = asked.kind, validate_only = asked.call.validate_only, prepare = std::move(prepare),
       check = std::move(check), begin = std::move(begin)](const Turn& turn, const Answer<Outcome>& respond) {
        auto prepared = prepare(turn);
        if (!prepared) return respond(tl::unexpected(prepared.error()));
        Result<void> good = check_right(kind, turn);
        if (good) good = validate_only ? check(turn, *prepared) : check_deadline(kind, turn.context, turn.now);
        if (!good) return respond(tl::unexpected(good.error()));
        validate_only ? respond(Result<Outcome>()) : begin(turn, *std::move(prepared), respond);
      });
}

template <class Outcome, class Begin>
void Pipeline::ask(const Asked& asked, Answer<Outcome> answer, Begin begin) const {
  Result<Admitted> admitted = admit(asked);
  if (!admitted) return answer(tl::unexpected(std::move(admitted.error())));
  server::Stage& device = *admitted->device;
  device.post([admitted = *std::move(admitted), answer = std::move(answer), begin = std::move(begin)](
                  stage::StageController& controller, TimePoint now) {
    begin(Turn{*admitted.device, controller, admitted.caller, admitted.context, now}, answer);
  });
}

}  // namespace axisgate::api
