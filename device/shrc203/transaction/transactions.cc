#include "device/shrc203/transaction/transactions.h"

#include <algorithm>
#include <string>
#include <utility>

#include "device/shrc203/limits.h"
#include "device/shrc203/motion/paths.h"
#include "device/shrc203/planning/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

// Settings of the whole controller are excluded: the manual does not say that a trigger's axis must be controllable.
Result<void> check_axes_there(const std::vector<Command>& commands, const Envelope& envelope) {
  const AxisSet controllable = envelope.state().controllable();
  for (const Command& command : commands) {
    const bool of_controller = command.row->effect == Effect::setting && command.row->scope == CommandScope::controller;
    const AxisSet missing = of_controller ? AxisSet() : command.axes(controllable) - controllable;
    if (!missing.empty()) return envelope.check_axis(missing.list().front());
  }
  return {};
}

// Reports whether an input could start a motion after these lines.
bool arms_inputs(const std::vector<Command>& commands) {
  return std::ranges::any_of(commands, [](const Command& one) {
    const bool step =
        one.row->meaning == Meaning::program_step && one.arguments.first("p").value_or("").starts_with("INPUT");
    return step || (one.row->reg == Register::wi && waits_of(one).set);
  });
}

void refuse(const StageController::OnExecute& event, Problem problem) {
  ExecuteEvent ended;
  ended.kind = ExecuteEvent::Kind::ended;
  ended.problem = std::move(problem);
  event(ended);
}

}  // namespace

void Transactions::execute(ExecuteRequest request, OnExecute event) {
  auto commands = check_lines(request.lines);
  if (!commands) return refuse(event, commands.error());
  if (request.context.not_after == TimePoint{}) request.context.not_after = tasks_.now() + kCallerWriteLimit;
  if (commands->front().row->effect == Effect::stop) return stop(commands->front(), request, std::move(event));
  if (const auto good = check(request, *commands); !good) return refuse(event, good.error());
  tasks_.spawn(run({std::move(request), *std::move(commands), std::move(event)}));
}

Result<void> Transactions::check(const ExecuteRequest& request, const std::vector<Command>& commands) {
  if (ending_) return tl::unexpected(*ending_);
  const State& state = store_.state();
  const bool panel = !store_.line_works() && store_.panel_is_wrong();
  if (state.controllable().empty() || state.link == LinkState::down || panel) return tl::unexpected(store_.not_up());
  const auto there = check_axes_there(commands, store_.envelope(request.context));
  if (!there) return there;
  if (non_host_.away() && !needs_gate(commands)) return tl::unexpected(non_host_.problem());
  if (arms_inputs(commands)) {
    const auto allowed = may_wait_for_inputs(store_.profile(), commands::setter_of(Register::wi).name);
    if (!allowed) return allowed;
  }
  if (auto forbidden = rights_.motion_forbidden(axes_moved(commands, state.controllable()))) {
    return tl::unexpected(*std::move(forbidden));
  }
  return rights_.authorize(request.context, axes_used(commands, state.controllable()));
}

Task<void> Transactions::run(Transaction transaction) {
  const bool begun = co_await start_.begin(transaction);
  if (!begun) co_return;
  const bool sent_all = co_await lines_.send_all(transaction);
  if (transaction.live) {
    co_await end_.end(transaction, sent_all);
  } else if (sent_all) {
    transaction.tell_end({});
  }
}

void Transactions::stop(const Command& command, const ExecuteRequest& request, OnExecute event) {
  const bool emergency = command.row->meaning == Meaning::emergency_stop;
  const AxisSet named = command.axes(store_.controllable());
  const AxisSet axes = emergency ? kAllAxes : named;
  motions_.stop_requested(request.context, axes);
  stops_.stop(named, emergency ? StopKind::emergency : StopKind::stop, request.context,
              [event = std::move(event), line = command.line](const StopReport& report) {
                ExecuteEvent reply;
                reply.sent = line;
                for (const auto& axis : report.axes) {
                  if (!axis.wire_reply.empty()) reply.wire_reply = axis.wire_reply;
                }
                reply.answer = reply.wire_reply;
                if (!reply.answer.empty()) event(reply);
                ExecuteEvent ended;
                ended.kind = ExecuteEvent::Kind::ended;
                ended.problem = report.problem;
                event(ended);
              });
}

}  // namespace axisgate::shrc203
