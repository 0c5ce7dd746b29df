#include "device/shrc203/transaction/transaction_lines.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/shot/line/closed_answers.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/planning/transaction_lines.h"

namespace axisgate::shrc203 {

Task<bool> TransactionLines::send_all(Transaction& transaction) {
  for (std::size_t index = 0; index < transaction.commands.size(); ++index) {
    const CommandRow& row = *transaction.commands[index].row;
    const bool continues =
        transaction.started != Transaction::Started::no && !row.moves() && row.effect != Effect::motion_setting;
    if (transaction.live && transaction.live->life.stop_asked() && !continues) {
      transaction.tell_end(stopped_by(*transaction.live));
      co_return false;
    }
    const bool sent = co_await send(transaction, index);
    if (!sent) co_return false;
  }
  co_return true;
}

ExchangeRequest TransactionLines::request_for(const Transaction& transaction, const Command& command) const {
  const LiveMotionPtr& live = transaction.live;
  ExchangeRequest request;
  request.command = as_sent(command);
  request.lane = live || command.row->effect != Effect::question ? Lane::motion : Lane::question;
  request.caller = transaction.who();
  request.not_after = transaction.request.context.not_after;
  if (non_host_.away()) {
    request.not_after = std::max(request.not_after, tasks_.now() + kStepWriteLimit);  // it must come back to HOST
  }
  request.motion = live ? live->motion.id : 0;
  if (!live) {
    request.identity = transaction.request.context.takes_turns_as();
    request.lease = transaction.request.context.lease;
    request.uses = axes_used({command}, store_.controllable());
  }
  const bool waits = command.row->reg != Register::none;  // no separate completion is documented for the end of a wait
  if (command.row->moves() && !waits && completes(transaction.commands)) request.completes = live->motion.axes;
  return request;
}

void TransactionLines::note_completions(const std::vector<int>& axes) {
  for (const int axis : axes) session_.completion_deduced(axis);
}

Task<ExchangeResult> TransactionLines::exchange(Transaction& transaction, Command command) {
  const bool closed = command.row->separation == Separation::closed && !motions_.any_chain();
  std::optional<int> before;
  ClosedAnswers answers;
  ExchangeResult result;
  for (int attempt = 0; attempt < kClosedQuestionTries; ++attempt) {
    auto request = request_for(transaction, command);
    request.closed = closed;
    auto pending = dialogue_.exchange(std::move(request));
    result = co_await pending;
    const auto& numbers = result.candidates;
    if (numbers.empty() || !guarded(Guard::two_answers_agree)) {
      const auto certain = result.reply ? parse_integer(result.reply->text) : std::nullopt;
      if (certain && !result.problem) note_completions(answers.settle(static_cast<int>(*certain)));
      co_return result;
    }
    note_completions(answers.take(numbers));
    // If the candidates belong to several axes, the answer may be any of them, or missing.
    const bool alone = std::ranges::count(numbers, numbers.front()) == std::ssize(numbers);
    if (!alone && guarded(Guard::answers_come_alone)) {
      before.reset();
      continue;
    }
    const int answer = numbers.front();
    if (std::exchange(before, answer) != answer) continue;
    result.reply->text = std::to_string(answer);
    result.candidates.clear();
    note_completions(answers.settle(answer));
    co_return result;
  }
  result.problem = Problem{.reason = Reason::completion_outstanding,
                           .message = "the answer could not be distinguished from an axis number",
                           .hint = "ask again once the motion has ended",
                           .sent = command.line};
  co_return result;
}

// Prepares a line that changes the mode: records the memory switches before the controller leaves HOST or returns to
// it.
Task<Result<void>> TransactionLines::leave_host(Transaction& transaction, Command command) {
  if (command.row->enters && !non_host_.away()) non_host_visit_.leave_host(transaction.live->motion.id);
  const auto known = co_await non_host_visit_.read_switches_before(transaction.live, transaction.audit, command);
  if (!known) co_return known;
  if (command.row->enters == Mode::host) {
    co_await non_host_visit_.read_switches_left(transaction.live, transaction.audit);
  }
  co_return Result<void>();
}

Task<bool> TransactionLines::send(Transaction& transaction, std::size_t index) {
  const Command& command = transaction.commands[index];
  ExecuteEvent event;
  event.line = index;
  event.sent = as_sent(command).line;
  if (transaction.live) motions_.written(*transaction.live);
  const auto left = co_await leave_host(transaction, command);
  if (!left) {
    transaction.tell_end(left.error());
    co_return false;
  }
  settings_.remember(transaction.request.context, command);
  const auto result = co_await exchange(transaction, command);
  note(transaction, command, result);
  if (result.problem) {
    transaction.tell_end(result.problem);
    co_return false;
  }
  event.wire_reply = result.reply->text;
  event.answer = picked(command, *result.reply, store_.controllable());
  transaction.tell(event);
  if (command.row->effect == Effect::question) {
    const bool answered = co_await was_answered(transaction, command, result.refused());
    co_return answered;
  }
  const bool accepted = co_await was_accepted(transaction, command, result.accepted());
  co_return accepted;
}

// Notes what the line has changed. If the answer was lost, the controller may have accepted the line.
void TransactionLines::note(Transaction& transaction, const Command& command, const ExchangeResult& result) {
  const CommandRow& row = *command.row;
  const AxisSet axes = command.axes(store_.controllable());
  const bool perhaps = result.accepted() || result.in_doubt();
  note_setting(store_, command, result);
  if (as_sent(command).line == commands::text(commands::Question::positions) && result.reply)
    reader_.note_positions(*result.reply);
  if (trigger_of(command) && result.accepted()) pending_.forget_scan();
  if (row.moves()) note_start(transaction, result);
  note_speeds(command, result);
  if (row.shifts_frame && !result.refused()) store_.shift_frame(axes);
  if (row.enters && perhaps) note_mode(transaction, *row.enters);
  if (row.rescales && !result.refused()) transaction.changed.insert(Transaction::Changed::scale);
  if (row.restarts && perhaps) transaction.changed.insert(Transaction::Changed::everything);
  if (row.reg == Register::wi && !result.refused()) {
    store_.note_armed(axes, waits_of(command).set);
    store_.publish();
  }
}

void TransactionLines::note_start(Transaction& transaction, const ExchangeResult& result) {
  if (result.in_doubt()) transaction.started = Transaction::Started::in_doubt;
  if (!result.accepted()) return;
  if (transaction.started == Transaction::Started::no) transaction.started = Transaction::Started::accepted;
  motions_.started(*transaction.live);
}

// A caller's own setting replaces the pending restore of the same speeds.
void TransactionLines::note_speeds(const Command& command, const ExchangeResult& result) {
  const AxisSet sped = axes_sped({command}, SetsSpeeds::of_motion, store_.controllable());
  store_.forget_speeds(sped);
  if (result.accepted() || result.in_doubt()) pending_.forget_speeds(sped);
}

void TransactionLines::note_mode(Transaction& transaction, Mode mode) {
  non_host_.entered(mode);
  if (mode == Mode::memory_switches) transaction.changed.insert(Transaction::Changed::memory_switches);
}

// NG is the answer to the question itself if no reason for a refusal is found.
Task<bool> TransactionLines::was_answered(Transaction& transaction, Command question, bool refused) {
  if (!refused) co_return true;
  const bool saved = question.row->meaning == Meaning::saved_position;
  auto why = co_await explainer_.explain_question(question, transaction.who());
  if (!why && saved) why = nothing_saved(question);
  if (!why) co_return true;
  transaction.tell_end(std::move(why));
  co_return false;
}

Task<bool> TransactionLines::was_accepted(Transaction& transaction, Command command, bool accepted) {
  if (!accepted) {
    auto why = co_await explainer_.explain(command, command.axes(store_.controllable()), transaction.who());
    transaction.tell_end(std::move(why));
    co_return false;
  }
  const bool program = command.row->moves() && command.row->needs.mode == Mode::program;
  if (!program) co_return true;
  const auto ended = co_await non_host_visit_.wait_for_program(transaction.live);
  if (!ended) transaction.tell_end(ended.error());
  co_return ended.has_value();
}

}  // namespace axisgate::shrc203
