// The path of every request to a device except a stop: role, device and context; then, on the device's strand, the
// right to all axes and the request's own checks; then the answer to validate_only, or the operation itself.
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

// An admitted request.
template <class Device>
struct AdmittedTo {
  Device* device = nullptr;  // never null
  server::Caller caller;
  use::RequestContext context;
};
using Admitted = AdmittedTo<server::Stage>;

// An admitted request on its device's strand.
template <class Device>
struct TurnOf {
  Device& device;
  typename Device::Controller& controller;
  const server::Caller& caller;
  const use::RequestContext& context;
  TimePoint now;
};
using Turn = TurnOf<server::Stage>;

// A request as the door passes it in.
template <class Device>
struct AskedOf {
  RequestKind kind;
  const Call& call;                // copied as far as needed
  Result<Device*> device;          // or the problem of finding it
  std::optional<Problem> fault{};  // problem of reading the rest of the request
};
using Asked = AskedOf<server::Stage>;

// Fails with deadline_passed if the request starts a motion and its time ran out while it was posted. A request that
// waits on the device beyond its not_after is refused there.
Result<void> check_deadline(RequestKind kind, const use::RequestContext& context, TimePoint now);

// A PipelineOf leads to one family of devices. Thread safe.
template <class Device>
class PipelineOf {
 public:
  using Asked = AskedOf<Device>;
  using Admitted = AdmittedTo<Device>;
  using Turn = TurnOf<Device>;
  template <class Outcome>
  using Repeat = RepeatOf<Device, Outcome>;

  // The referenced objects must outlive this one.
  PipelineOf(const Admission& admission, const Mutations& mutations) : admission_(admission), mutations_(mutations) {}

  // Fails, in this order, with unauthenticated or not_allowed; invalid_request or unknown_device; invalid_request for
  // the request_id; as Admission::context_of() does; and with Asked::fault.
  Result<Admitted> admit(const Asked& asked) const;

  // Posts the request to the device. There `prepare` computes the operation from the request and the device's state, or
  // refuses it; `check` runs the device's checks, and is the last step of validate_only; `describe` returns the text
  // for the log and the journal; `begin` starts the operation and answers.
  //   Result<Prepared> prepare(const Turn&)
  //   Result<void> check(const Turn&, const Prepared&)
  //   std::string describe(const Prepared&)
  //   void begin(const Turn&, Prepared, const Answer<Outcome>&)
  // The answer to validate_only is an empty Outcome. `repeat` answers a request whose id is known. Between `check` and
  // `begin` the journal may take time: `begin` must let the controller check the operation again.
  template <class Outcome, class Prepare, class Check, class Describe, class Begin>
  void run(const Asked& asked, Answer<Outcome> answer, Prepare prepare, Check check, Describe describe, Begin begin,
           std::type_identity_t<Repeat<Outcome>> repeat = usual_repeat<Device, Outcome>()) const;

  // Runs a request that changes something and answers by itself. `ready` is called on the strand before the request is
  // written to the journal; it returns the description of the operation, or refuses it. `still_ready` is called after
  // that if it took time; without it, `ready` is called again. `begin` starts the operation, and reports its result to
  // the mutation. `refuse` and `repeat` are called from any thread.
  //   Result<std::string> ready(const Turn&)
  //   Result<> still_ready(const Turn&)
  //   void begin(const Turn&, const MutationPtr&)
  //   void refuse(const Problem&)
  //   void repeat(Device&, const Result<Known>&)
  template <class Ready, class StillReady, class Begin, class Refuse, class Again>
  void act(const Asked& asked, Ready ready, StillReady still_ready, Begin begin, Refuse refuse, Again repeat) const;
  template <class Ready, class Begin, class Refuse, class Again>
  void act(const Asked& asked, Ready ready, Begin begin, Refuse refuse, Again repeat) const {
    act(asked, ready, ready, std::move(begin), std::move(refuse), std::move(repeat));
  }

  // Does the same for a request that neither moves nor changes anything on the device: it does not wait for the
  // journal, and validate_only is ignored.
  //   void begin(const Turn&, const Answer<Outcome>&)
  template <class Outcome, class Begin>
  void once(const Asked& asked, Answer<Outcome> answer, Begin begin,
            std::type_identity_t<Repeat<Outcome>> repeat = usual_repeat<Device, Outcome>()) const;

  // Runs a request without checks on the device; validate_only is ignored.
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
  // Reports whether the operation may begin now.
  static Result<void> check_now(RequestKind kind, const Turn& turn);
  // A request that starts a motion requires that the device is up. This is checked first: plans need data that only a
  // connected device has, so the problem of the plan would hide that the line is down.
  static Result<void> check_up(RequestKind kind, const Turn& turn);

  const Admission& admission_;
  const Mutations& mutations_;
};
using Pipeline = PipelineOf<server::Stage>;
// For requests that all kinds of devices support.
using DevicePipeline = PipelineOf<server::Device>;

template <class Device>
Result<typename PipelineOf<Device>::Identified> PipelineOf<Device>::identify(const Asked& asked) const {
  Result<server::Caller> caller = admission_.check_role(asked.kind, asked.call.credential);
  if (!caller) return tl::unexpected(caller.error());
  if (!asked.device) return tl::unexpected(asked.device.error());
  const DeadlineRule rule = rule_of(asked.kind).deadline;
  if (rule == DeadlineRule::change || rule == DeadlineRule::motion) {
    if (const auto good = Admission::check_request_id(asked.call); !good) return tl::unexpected(good.error());
  }
  return Identified{*asked.device, *std::move(caller)};
}

template <class Device>
Result<AdmittedTo<Device>> PipelineOf<Device>::admit(const Asked& asked, Identified identified) const {
  Result<use::RequestContext> context = admission_.context_of(asked.kind, asked.call, identified.caller);
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
Result<void> PipelineOf<Device>::check_up(RequestKind kind, const Turn& turn) {
  if constexpr (std::is_same_v<Device, server::Stage>) {
    if (rule_of(kind).deadline == DeadlineRule::motion) return turn.controller.check_up();
  }
  return {};
}

template <class Device>
template <class Ready, class StillReady, class Begin, class Refuse, class Again>
void PipelineOf<Device>::act(const Asked& asked, Ready ready, StillReady still_ready, Begin begin, Refuse refuse,
                             Again repeat) const {
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
  // Both visits to the strand share this.
  struct Visit {
    Admitted admitted;
    Ready ready;
    StillReady still_ready;
    Begin begin;
  };
  const auto visit =
      std::make_shared<Visit>(Visit{*std::move(admitted), std::move(ready), std::move(still_ready), std::move(begin)});
  using Controller = typename Device::Controller;
  const auto too_late = [refuse_it] { refuse_it(daemon_ending()); };
  const auto come = [kind = asked.kind, visit, mutation, refuse_it, too_late](Controller& controller, TimePoint now) {
    const Admitted& it = visit->admitted;
    const Turn turn{*it.device, controller, it.caller, it.context, now};
    const Result<void> up = check_up(kind, turn);
    const Result<std::string> what = up ? visit->ready(turn) : tl::unexpected(up.error());
    if (!what) return refuse_it(what.error());
    audit(kind, turn.device, turn.context, *what);
    const auto come_again = [kind, visit, mutation, refuse_it](Controller& same, TimePoint later) {
      const Admitted& still = visit->admitted;
      const Turn second{*still.device, same, still.caller, still.context, later};
      if (const Result<void> still_up = check_up(kind, second); !still_up) return refuse_it(still_up.error());
      const auto yet = visit->still_ready(second);
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
  using Prepared = typename std::invoke_result_t<Prepare, const Turn&>::value_type;
  const auto prepared = std::make_shared<std::optional<Prepared>>();
  act(
      asked,
      [kind = asked.kind, prepare, check, describe, prepared](const Turn& turn) -> Result<std::string> {
        auto operation = prepare(turn);
        if (!operation) return tl::unexpected(operation.error());
        Result<void> good = check_now(kind, turn);
        if (good) good = check(turn, *operation);
        if (good) good = turn.controller.check_use(turn.context, axes_used(*operation, turn.controller.state()));
        if (!good) return tl::unexpected(good.error());
        prepared->emplace(*std::move(operation));
        return describe(**prepared);
      },
      [kind = asked.kind](const Turn& turn) { return check_now(kind, turn); },
      [prepared, begin, answer](const Turn& turn, const MutationPtr& mutation) {
        begin(turn, *std::move(*prepared), settling(mutation, answer));
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
