// What a caller's lines must pass before they become a transaction; a stop among them goes its own way.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/transaction/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

// Of a trigger's axis the manual says nothing.
Result<void> check_axes_there(const std::vector<Command>& commands, const Envelope& envelope) {
  const AxisSet controllable = envelope.state().controllable();
  for (const Command& command : commands) {
    const bool of_controller = command.row->effect == Effect::setting && command.row->scope == CommandScope::controller;
    const AxisSet missing = of_controller ? AxisSet() : command.axes(controllable) - controllable;
    if (!missing.empty()) return envelope.check_axis(missing.list().front());
  }
  return {};
}

}  // namespace

void Controller::Impl::execute(ExecuteRequest request, OnExecute event) {
  const auto refuse = [&event](Problem problem) {
    ExecuteEvent ended;
    ended.kind = ExecuteEvent::Kind::ended;
    ended.problem = std::move(problem);
    event(ended);
  };
  auto checked = check_lines(request.lines);
  if (!checked) return refuse(checked.error());
  std::vector<Command> commands = *std::move(checked);
  if (ending_ && commands.front().row->effect != Effect::stop) return refuse(*ending_);
  const bool panel = !line_works() && panel_is_wrong();
  if (state_.controllable().empty() || state_.link == LinkState::down || panel) {
    if (commands.front().row->effect != Effect::stop) {
      return refuse(not_up());
    }
  }
  request.context.not_after = default_limit(request.context.not_after, kCallerWriteLimit);
  if (commands.front().row->effect == Effect::stop) return execute_stop(commands.front(), request, std::move(event));
  if (const auto there = check_axes_there(commands, envelope(request.context)); !there) return refuse(there.error());
  if (away_ && !needs_gate(commands)) return refuse(away_problem());
  const bool arms = std::ranges::any_of(commands, [](const Command& one) {
    const bool step =
        one.row->meaning == Meaning::program_step && one.arguments.first("p").value_or("").starts_with("INPUT");
    return step || (one.row->reg == Register::wi && waits_of(one).set);
  });
  const auto may_wait = may_wait_for_inputs(commands::setter_of(Register::wi).name);
  if (arms && !may_wait) return refuse(may_wait.error());
  const auto allowed = may_use(request.context, axes_used(commands, state_.controllable()));
  if (!allowed) return refuse(allowed.error());
  executor_.spawn(run_transaction(std::move(request), std::move(commands), std::move(event)));
}

Result<void> Controller::Impl::may_wait_for_inputs(std::string_view what) const {
  if (profile_.wait_for_inputs || !guarded(Guard::inputs_start_nothing)) return {};
  return fail(Reason::not_allowed,
              fmt::format("{} lets an input pin start a motion, whoever may stand beside the stage", what),
              "an administrator may allow it for this device: wait_for_inputs = true");
}

void Controller::Impl::execute_stop(const Command& command, const ExecuteRequest& request, OnExecute event) {
  const bool emergency = command.row->meaning == Meaning::emergency_stop;
  const AxisSet axes = emergency ? AxisSet::all() : command.axes(state_.controllable());
  permission_.stop_asked({request.context.who, request.context.lease, axes, 0}, now_);
  stop(command.axes(state_.controllable()), emergency, request.context,
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
