// BEC: (manual 53)), on request only: it clears limit, overflow and emergency errors, and what they say of BUSY.
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

Task<void> Controller::Impl::clear_errors(AxisSet axes, RequestContext context, OnDone done) {
  ExchangeRequest request;
  const AxisSet named = axes.empty() ? state_.controllable() : axes;
  if (named.empty()) {
    done(tl::unexpected(not_up()));
    co_return;
  }
  if (away_) {
    done(tl::unexpected(away_problem()));
    co_return;
  }
  if (const auto allowed = may_use(context, named); !allowed) {
    done(tl::unexpected(allowed.error()));
    co_return;
  }
  request.command = commands::clear_errors(named);
  request.lease = context.lease;
  request.uses = named;
  request.lane = Lane::motion;
  request.caller = context.who;
  request.not_after = default_limit(context.not_after, kCallerWriteLimit);
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  settled_ = false;
  if (result.problem) {
    done(tl::unexpected(*result.problem));
    co_return;
  }
  auto read = co_await read_excitation(context.who);
  if (read) read = co_await read_positions(Lane::question, context.who);
  if (!result.accepted()) {
    done(fail(Reason::device_refused, "the controller refused BEC: (NG)", "see `axisctl status`"));
  } else if (!read) {
    done(tl::unexpected(read.error()));
  } else {
    done({});
  }
}

}  // namespace axisgate::shrc203
