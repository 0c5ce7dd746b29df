#include "device/shrc203/session/clear_errors.h"

#include <utility>

#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

void ErrorClearing::clear(AxisSet axes, RequestContext context, StageController::OnDone done) {
  tasks_.spawn(run(axes, std::move(context), std::move(done)));
}

Task<void> ErrorClearing::run(AxisSet axes, RequestContext context, StageController::OnDone done) {
  ExchangeRequest request;
  const AxisSet named = axes.empty() ? store_.controllable() : axes;
  if (named.empty()) {
    done(tl::unexpected(store_.not_up()));
    co_return;
  }
  if (non_host_.away()) {
    done(tl::unexpected(non_host_.problem()));
    co_return;
  }
  if (const auto allowed = rights_.authorize(context, named); !allowed) {
    done(tl::unexpected(allowed.error()));
    co_return;
  }
  request.command = commands::clear_errors(named);
  request.lease = context.lease;
  request.uses = named;
  request.lane = Lane::motion;
  request.caller = context.who;
  request.identity = context.takes_turns_as();
  request.not_after = context.not_after == TimePoint{} ? tasks_.now() + kCallerWriteLimit : context.not_after;
  auto pending = dialogue_.exchange(std::move(request));
  const auto result = co_await pending;
  store_.unsettle();
  if (result.problem) {
    done(tl::unexpected(*result.problem));
    co_return;
  }
  auto read = co_await reader_.read_excitation(context.who);
  if (read) read = co_await reader_.read_positions(Lane::question, context.who);
  if (!result.accepted()) {
    done(fail(Reason::device_refused, "the controller refused BEC: (NG)", "see `axisctl status`"));
  } else if (!read) {
    done(tl::unexpected(read.error()));
  } else {
    done({});
  }
}

}  // namespace axisgate::shrc203
