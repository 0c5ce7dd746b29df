#include "device/shrc203/transaction/transaction_start.h"

#include <algorithm>

#include "device/shrc203/motion/saved_positions.h"
#include "device/shrc203/planning/transaction_lines.h"
#include "device/shrc203/planning/transaction_prediction.h"

namespace axisgate::shrc203 {

void TransactionStart::create_motion(Transaction& transaction) {
  const AxisSet controllable = store_.controllable();
  const AxisSet axes = axes_moved(transaction.commands, controllable);
  auto live = motions_.create(MotionKind::execute, axes, transaction.request.context, {});
  live->uses = axes_used(transaction.commands, controllable);
  const bool needs_excitation =
      std::ranges::any_of(transaction.commands, [](const Command& command) { return command.row->needs.excited; });
  if (!needs_excitation) live->excited = {};
  transaction.live = live;
}

Task<bool> TransactionStart::begin(Transaction& transaction) {
  if (!needs_gate(transaction.commands)) {
    const auto learned = co_await settings_.learn(transaction.commands, transaction.who());
    if (!learned) transaction.tell_end(learned.error());
    co_return learned.has_value();
  }
  create_motion(transaction);
  const auto begun = co_await take_turn(transaction);
  if (!begun) {
    transaction.tell_end(begun.error());
    motions_.refuse(*transaction.live, begun.error());
    co_return false;
  }
  ExecuteEvent named;
  named.kind = ExecuteEvent::Kind::motion;
  named.motion = transaction.live->motion.id;
  transaction.tell(named);
  transaction.live->on_completion = [&transaction](int axis) {
    ExecuteEvent event;
    event.kind = ExecuteEvent::Kind::completion;
    event.axis = axis;
    transaction.tell(event);
  };
  co_return true;
}

Task<Result<void>> TransactionStart::take_turn(Transaction& transaction) {
  const LiveMotionPtr live = transaction.live;
  auto ready = co_await motions_.enter(live, completes(transaction.commands));
  if (ready) ready = co_await settings_.learn(transaction.commands, transaction.who());
  if (ready) ready = co_await learn_speeds(transaction);
  if (!ready) co_return ready;
  if (leaves_host(transaction.commands) && !store_.line_works()) co_return tl::unexpected(store_.not_up());
  if (live->motion.axes.empty()) co_return check_envelope(transaction);
  Register reg = Register::none;
  for (const Command& command : transaction.commands) {
    if (command.row->reg != Register::none) reg = command.row->reg;
  }
  ready = co_await entry_.prepare(live, reg);
  if (ready) ready = co_await ask_for_destination(transaction);
  if (!ready) co_return ready;
  co_return check_envelope(transaction);
}

// Speeds that the lines set must be known first, so that they can be restored. Pending restores come before lines such
// as DS:, which set only a part of the speeds.
Task<Result<void>> TransactionStart::learn_speeds(Transaction& transaction) {
  const bool moves = !transaction.live->motion.axes.empty();
  const AxisSet sped = axes_sped(transaction.commands, SetsSpeeds::of_motion, store_.controllable());
  if (!moves) co_await restorer_.restore_speeds(sped, transaction.who());
  if (sped.empty()) co_return Result<void>();
  const auto learned = co_await reader_.learn_speeds(sped, transaction.who());
  // A D: without motion can correct impossible speeds, so it does not need the present ones.
  if (!learned && moves) co_return learned;
  co_return Result<void>();
}

Task<Result<void>> TransactionStart::ask_for_destination(Transaction& transaction) {
  const auto question = destination_question(transaction.commands.front());
  if (!question) co_return Result<void>();
  const auto reported = co_await ask_for_position(dialogue_, transaction.live, *question, store_.controllable());
  if (!reported) co_return tl::unexpected(reported.error());
  if (reported->empty()) {
    const auto why = co_await explainer_.explain_question(*question, transaction.who());
    co_return tl::unexpected(why ? *why : nothing_saved(*question));
  }
  for (const auto& [axis, pulses] : *reported) transaction.destination[static_cast<std::size_t>(axis - 1)] = pulses;
  co_return Result<void>();
}

Result<void> TransactionStart::check_envelope(Transaction& transaction) {
  LiveMotion& live = *transaction.live;
  const Positions begin = store_.positions();
  TransactionPrediction prediction(store_.envelope(transaction.request.context), begin, store_.speeds(live.motion.axes),
                                   store_.controllable());
  for (const Command& command : transaction.commands) {
    const auto good =
        destination_question(command) ? prediction.go_to(transaction.destination) : prediction.add(command);
    if (!good) return good;
  }
  bool round_trip = std::ranges::any_of(transaction.commands, [](const Command& command) {
    return command.row->reg == Register::e || command.row->reg == Register::ep;
  });
  for (auto& result : live.motion.results) {
    const auto place = static_cast<std::size_t>(result.axis - 1);
    round_trip = round_trip && prediction.at()[place] == begin[place];
    result.target_pulses = prediction.at()[place];
  }
  live.goal = round_trip ? Goal::round_trip : Goal::targets;
  return {};
}

}  // namespace axisgate::shrc203
