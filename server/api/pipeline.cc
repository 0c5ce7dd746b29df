#include "server/api/pipeline.h"

namespace axisgate::api {

Result<void> check_deadline(RequestKind kind, const stage::RequestContext& context, TimePoint now) {
  if (rule_of(kind).patience != Patience::motion || now <= context.not_after) return {};
  return fail(Reason::deadline_passed, "the request came to the device after its not_after",
              "ask again, with a later not_after");
}

Result<Pipeline::Identified> Pipeline::identify(const Asked& asked) const {
  Result<server::Caller> caller = admission_.check_role(asked.kind, asked.call.credential);
  if (!caller) return tl::unexpected(caller.error());
  if (!asked.device) return tl::unexpected(asked.device.error());
  const Patience patience = rule_of(asked.kind).patience;
  if (patience == Patience::change || patience == Patience::motion) {
    if (const auto good = Admission::check_request_id(asked.call); !good) return tl::unexpected(good.error());
  }
  return Identified{*asked.device, *std::move(caller)};
}

Result<Admitted> Pipeline::admit(const Asked& asked, Identified identified) const {
  Result<stage::RequestContext> context = admission_.context_of(asked.kind, asked.call, identified.caller);
  if (!context) return tl::unexpected(context.error());
  if (asked.fault) return tl::unexpected(*asked.fault);
  return Admitted{identified.device, std::move(identified.caller), *std::move(context)};
}

Result<Admitted> Pipeline::admit(const Asked& asked) const {
  Result<Identified> identified = identify(asked);
  if (!identified) return tl::unexpected(identified.error());
  return admit(asked, *std::move(identified));
}

Result<void> Pipeline::check_right(RequestKind kind, const Turn& turn) {
  if (rule_of(kind).use != Use::all_axes) return {};
  return turn.controller.check_use(turn.context, turn.controller.state().controllable());
}

Result<void> Pipeline::check_now(RequestKind kind, const Turn& turn) {
  const Result<void> right = check_right(kind, turn);
  return right ? check_deadline(kind, turn.context, turn.now) : right;
}

}  // namespace axisgate::api
