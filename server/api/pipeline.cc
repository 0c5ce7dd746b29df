#include "server/api/pipeline.h"

namespace axisgate::api {

Result<void> check_deadline(RequestKind kind, const stage::RequestContext& context, TimePoint now) {
  if (rule_of(kind).patience != Patience::motion || now <= context.not_after) return {};
  return fail(Reason::deadline_passed, "the request came to the device after its not_after",
              "ask again, with a later not_after");
}

Result<Admitted> Pipeline::admit(const Asked& asked) const {
  Result<server::Caller> caller = admission_.check_role(asked.kind, asked.call.credential);
  if (!caller) return tl::unexpected(caller.error());
  if (!asked.device) return tl::unexpected(asked.device.error());
  Result<stage::RequestContext> context = admission_.context_of(asked.kind, asked.call, *caller);
  if (!context) return tl::unexpected(context.error());
  if (asked.fault) return tl::unexpected(*asked.fault);
  return Admitted{*asked.device, *std::move(caller), *std::move(context)};
}

Result<void> Pipeline::check_right(RequestKind kind, const Turn& turn) {
  if (rule_of(kind).use != Use::all_axes) return {};
  return turn.controller.check_use(turn.context, turn.controller.state().controllable());
}

}  // namespace axisgate::api
