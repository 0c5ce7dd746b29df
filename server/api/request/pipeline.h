// The way of every request to a device but a stop: role, device, context; on the device's strand the right to all axes,
// the request's own checks, and then either the answer to validate_only or the operation itself.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "device/core/problem.h"
#include "device/stage/stage_controller.h"
#include "server/api/request/admission.h"
#include "server/api/request/audit.h"
#include "server/api/request/axes_used.h"
#include "server/api/request/call.h"
#include "server/api/request/ending.h"
#include "server/api/request/mutations.h"
#include "server/api/request/repeats.h"
#include "server/api/request/request_kinds.h"
#include "server/devices/stage.h"

namespace axisgate::api {

// A request that was let in.
template <class Device>
struct AdmittedTo {
  Device* device = nullptr;  // never null
  server::Caller caller;
  stage::RequestContext context;
};
using Admitted = AdmittedTo<server::Stage>;

// Such a request on its device's strand.
template <class Device>
struct TurnOf {
  Device& device;
  typename Device::Controller& controller;
  const server::Caller& caller;
  const stage::RequestContext& context;
  TimePoint now;
};
using Turn = TurnOf<server::Stage>;

// What a door hands in.
template <class Device>
struct AskedOf {
  RequestKind kind;
  const Call& call;                // copied as far as it is needed
  Result<Device*> device;          // or why there is none
  std::optional<Problem> fault{};  // of how the rest is written
};
using Asked = AskedOf<server::Stage>;

// deadline_passed for what would start a motion after its not_after: while it was posted, its time ran out. What waits
// on the device longer than that is refused there.
Result<void> check_deadline(RequestKind kind, const stage::RequestContext& context, TimePoint now);

// To one family of devices. Thread safe.
template <class Device>
class PipelineOf {
 public:
  using Asked = AskedOf<Device>;
  using Admitted = AdmittedTo<Device>;
  using Turn = TurnOf<Device>;
  template <class Outcome>
  using Repeat = RepeatOf<Device, Outcome>;

  // Both outlive this.
  PipelineOf(const Admission& admission, const Mutations& mutations) : admission_(admission), mutations_(mutations) {}

  // In this order: unauthenticated, not_allowed; invalid_request or unknown_device; invalid_request for a request_id;
  // the fault of the rest.
  Result<Admitted> admit(const Asked& asked) const;

  // Posts to the device. There `prepare` makes what is to be done of the request and the device's state, or refuses;
  // `check` does the checks of the device, also where validate_only ends the request there; `describe` says what it is,
  // for the log and the journal; `begin` does it and answers.
  //   Result<Prepared> prepare(const Turn&), several times
  //   Result<void> check(const Turn&, const Prepared&)
  //   std::string describe(const Prepared&)
  //   void begin(const Turn&, Prepared, const Answer<Outcome>&)
  // The answer to validate_only is an empty Outcome. A request whose id has come before is answered by `repeat`.
  template <class Outcome, class Prepare, class Check, class Describe, class Begin>
  void run(const Asked& asked, Answer<Outcome> answer, Prepare prepare, Check check, Describe describe, Begin begin,
           std::type_identity_t<Repeat<Outcome>> repeat = usual_repeat<Device, Outcome>()) const;

  // What changes something, and answers in its own way. `ready` is called on the strand, before it is in the journal
  // and, where that has taken time, again: whether it may be done now, and what it is. `begin` does it, and says what
  // became of it. `refuse` and `repeat` are called from any thread.
  //   Result<std::string> ready(const Turn&)
  //   void begin(const Turn&, const MutationPtr&)
  //   void refuse(const Problem&)
  //   void repeat(Device&, const Result<Known>&)
  template <class Ready, class Begin, class Refuse, class Again>
  void act(const Asked& asked, Ready ready, Begin begin, Refuse refuse, Again repeat) const;

  // The same for what moves and changes nothing on the device: it waits for no journal, and has no validate_only.
  //   void begin(const Turn&, const Answer<Outcome>&)
  template <class Outcome, class Begin>
  void once(const Asked& asked, Answer<Outcome> answer, Begin begin,
            std::type_identity_t<Repeat<Outcome>> repeat = usual_repeat<Device, Outcome>()) const;

  // For what has nothing to check there, and no validate_only.
  //   void begin(const Turn&, const Answer<Outcome>&)
  template <class Outcome, class Begin>
  void ask(const Asked& asked, Answer<Outcome> answer, Begin begin) const;

 private:
  struct Identified {
    Device* device = nullptr;  // never null
    server::Caller caller;
  };
  Result<Identified> identify(const Asked& asked) const;
  Result<Admitted> admit(const Asked& asked, Identified identified) const;
  static Result<void> check_right(RequestKind kind, const Turn& turn);
  // Whether it may be done now.
  static Result<void> check_now(RequestKind kind, const Turn& turn);
  // What `ready` says. Of what starts a motion, first whether the device is up: plans need what only a device that is
  // up can say, so without this check the plan's reason would hide that the line is down.
  template <class Ready>
  static Result<std::string> ready_if_up(RequestKind kind, const Turn& turn, Ready& ready);

  const Admission& admission_;
  const Mutations& mutations_;
};
using Pipeline = PipelineOf<server::Stage>;
// For what is requested of every device, whatever its kind.
using DevicePipeline = PipelineOf<server::Device>;

template <class Device>
Result<typename PipelineOf<Device>::Identified> PipelineOf<Device>::identify(const Asked& asked) const {
  Result<server::Caller> caller = admission_.check_role(asked.kind, asked.call.credential);
  if (!caller) return tl::unexpected(caller.error());
  if (!asked.device) return tl::unexpected(asked.device.error());
  const Patience patience = rule_of(asked.kind).patience;
  if (patience == Patience::change || patience == Patience::motion) {
    if (const auto good = Admission::check_request_id(asked.call); !good) return tl::unexpected(good.error());
  }
  return Identified{*asked.device, *std::move(caller)};
}

template <class Device>
Result<AdmittedTo<Device>> PipelineOf<Device>::admit(const Asked& asked, Identified identified) const {
  Result<stage::RequestContext> context = admission_.context_of(asked.kind, asked.call, identified.caller);
  if (!context) return tl::unexpected(context.error());
  if (asked.fault) return tl::unexpected(*asked.fault);
  return Admitted{identified.device, std::move(identified.caller), *std::move(context)};
}

template <class Device>
Result<AdmittedTo<Device>> PipelineOf<Device>::admit(const Asked& asked) const {
  Result<Identified> identified = identify(asked);
  if (!identified) return tl::unexpected(identified.error());
  return admit(asked, *std::move(identified));
}

template <class Device>
Result<void> PipelineOf<Device>::check_right(RequestKind kind, const Turn& turn) {
  if (rule_of(kind).use != Use::all_axes) return {};
  return turn.controller.check_use(turn.context, turn.controller.state().controllable());
}

template <class Device>
Result<void> PipelineOf<Device>::check_now(RequestKind kind, const Turn& turn) {
  const Result<void> right = check_right(kind, turn);
  return right ? check_deadline(kind, turn.context, turn.now) : right;
}

template <class Device>
template <class Ready>
Result<std::string> PipelineOf<Device>::ready_if_up(RequestKind kind, const Turn& turn, Ready& ready) {
  if constexpr (std::is_same_v<Device, server::Stage>) {
    const bool moves = rule_of(kind).patience == Patience::motion;
    if (const auto up = moves ? turn.controller.check_up() : Result<void>(); !up) return tl::unexpected(up.error());
  }
  return ready(turn);
}

template <class Device>
template <class Ready, class Begin, class Refuse, class Again>
void PipelineOf<Device>::act(const Asked& asked, Ready ready, Begin begin, Refuse refuse, Again repeat) const {
  const Result<Identified> identified = identify(asked);
  if (!identified) return refuse(identified.error());
  Device& device = *identified->device;
  const auto begun = mutations_.begin(asked.kind, asked.call, device, identified->caller.who,
                                      [&device, repeat](const auto& known) { repeat(device, known); });
  if (!begun) return refuse(begun.error());
  if (*begun == nullptr) return;
  const MutationPtr mutation = *begun;
  auto refuse_it = [mutation, refuse](const Problem& problem) {
    mutation->failed(problem);
    refuse(problem);
  };
  Result<Admitted> admitted = admit(asked, *identified);
  if (!admitted) return refuse_it(admitted.error());
  // Shared by the two visits to the strand.
  struct Visit {
    Admitted admitted;
    Ready ready;
    Begin begin;
  };
  const auto visit = std::make_shared<Visit>(Visit{*std::move(admitted), std::move(ready), std::move(begin)});
  using Controller = typename Device::Controller;
  const auto too_late = [refuse_it] { refuse_it(daemon_ending()); };
  const auto come = [kind = asked.kind, visit, mutation, refuse_it, too_late](Controller& controller, TimePoint now) {
    const Admitted& it = visit->admitted;
    const Turn turn{*it.device, controller, it.caller, it.context, now};
    const Result<std::string> what = ready_if_up(kind, turn, visit->ready);
    if (!what) return refuse_it(what.error());
    audit(kind, turn.device, turn.context, *what);
    const auto come_again = [kind, visit, mutation, refuse_it](Controller& same, TimePoint later) {
      const Admitted& still = visit->admitted;
      const Turn second{*still.device, same, still.caller, still.context, later};
      const Result<std::string> yet = ready_if_up(kind, second, visit->ready);
      yet ? visit->begin(second, mutation) : refuse_it(yet.error());
    };
    const auto then = [visit, come_again, refuse_it, too_late](const Result<void>& written) {
      written ? visit->admitted.device->post(come_again, too_late) : refuse_it(written.error());
    };
    if (!mutation->intend(it.context, *what, then)) visit->begin(turn, mutation);
  };
  device.post(come, too_late);
}

template <class Device>
template <class Outcome, class Prepare, class Check, class Describe, class Begin>
void PipelineOf<Device>::run(const Asked& asked, Answer<Outcome> answer, Prepare prepare, Check check,
                             Describe describe, Begin begin, std::type_identity_t<Repeat<Outcome>> repeat) const {
  if (asked.call.validate_only) {
    return ask(asked, std::move(answer),
               [kind = asked.kind, prepare, check](const Turn& turn, const Answer<Outcome>& respond) {
                 auto prepared = prepare(turn);
                 if (!prepared) return respond(tl::unexpected(prepared.error()));
                 Result<void> good = check_right(kind, turn);
                 if (good) good = check(turn, *prepared);
                 good ? respond(Result<Outcome>()) : respond(tl::unexpected(good.error()));
               });
  }
  act(
      asked,
      [kind = asked.kind, prepare, check, describe](const Turn& turn) -> Result<std::string> {
        auto prepared = prepare(turn);
        if (!prepared) return tl::unexpected(prepared.error());
        Result<void> good = check_now(kind, turn);
        if (good) good = check(turn, *prepared);
        if (good) good = turn.controller.check_use(turn.context, axes_used(*prepared, turn.controller.state()));
        if (!good) return tl::unexpected(good.error());
        return describe(*prepared);
      },
      [prepare, begin, answer](const Turn& turn, const MutationPtr& mutation) {
        const Answer<Outcome> respond = settling(mutation, answer);
        auto prepared = prepare(turn);
        prepared ? begin(turn, *std::move(prepared), respond) : respond(tl::unexpected(prepared.error()));
      },
      [answer](const Problem& problem) { answer(tl::unexpected(problem)); },
      [repeat, answer](Device& device, const auto& known) { repeat(device, known, answer); });
}

template <class Device>
template <class Outcome, class Begin>
void PipelineOf<Device>::once(const Asked& asked, Answer<Outcome> answer, Begin begin,
                              std::type_identity_t<Repeat<Outcome>> repeat) const {
  act(
      asked, [](const Turn&) { return Result<std::string>(""); },
      [begin, answer](const Turn& turn, const MutationPtr& mutation) { begin(turn, settling(mutation, answer)); },
      [answer](const Problem& problem) { answer(tl::unexpected(problem)); },
      [repeat, answer](Device& device, const auto& known) { repeat(device, known, answer); });
}

template <class Device>
template <class Outcome, class Begin>
void PipelineOf<Device>::ask(const Asked& asked, Answer<Outcome> answer, Begin begin) const {
  Result<Admitted> admitted = admit(asked);
  if (!admitted) return answer(tl::unexpected(std::move(admitted.error())));
  Device& device = *admitted->device;
  const auto too_late = [answer] { answer(tl::unexpected(daemon_ending())); };
  device.post(
      [admitted = *std::move(admitted), answer = std::move(answer), begin = std::move(begin)](
          typename Device::Controller& controller, TimePoint now) {
        begin(Turn{*admitted.device, controller, admitted.caller, admitted.context, now}, answer);
      },
      too_late);
}

}  // namespace axisgate::api
