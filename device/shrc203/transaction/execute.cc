// A caller's own lines as one transaction: checked by the table, and nobody else's motion between them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/line/closed_answers.h"
#include "device/shrc203/planning/forecast.h"
#include "device/shrc203/session/switch_audit.h"
#include "device/shrc203/transaction/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

Problem nothing_saved(const Command& question) {
  return {.reason = Reason::not_found,
          .message = fmt::format("nothing is saved under number {}", question.arguments.first("n").value_or("")),
          .hint = "save a position there first; a restart of the controller forgets places (PIT:)",
          .sent = question.line,
          .wire_reply = "NG"};
}

// One caller's transaction.
class Transaction {
 public:
  Transaction(Controller::Impl& owner, ExecuteRequest request, std::vector<Command> commands,
              Controller::OnExecute tell)
      : impl_(owner), request_(std::move(request)), commands_(std::move(commands)), tell_(std::move(tell)) {}

  Task<void> run();

 private:
  Task<Result<void>> begin();
  Task<bool> send_all();
  Task<Result<void>> read_what_is_set();
  Task<bool> send(std::size_t index);
  Task<bool> answered(Command question, bool refused);
  Task<ExchangeResult> exchange(const Command& command);
  bool single_motion() const;
  Task<Result<void>> ask_for_destination();
  Result<void> check_envelope();
  ExchangeRequest request_for(const Command& command);
  void end(std::optional<Problem> problem);

  Controller::Impl& impl_;
  ExecuteRequest request_;
  std::vector<Command> commands_;
  Controller::OnExecute tell_;
  LiveMotionPtr live_;
  bool started_ = false;
  bool start_in_doubt_ = false;
  bool switches_ = false;  // memory switches may have been changed
  SwitchAudit audit_;
  Positions destination_{};  // a saved position, where it goes to one
  bool rescaled_ = false, restarted_ = false;
};

void Transaction::end(std::optional<Problem> problem) {
  ExecuteEvent event;
  event.kind = ExecuteEvent::Kind::ended;
  event.problem = std::move(problem);
  tell_(event);
}

Result<void> Transaction::check_envelope() {
  Forecast forecast(impl_.envelope(request_.context), positions_of(impl_.state_),
                    impl_.known_speeds(live_->motion.axes), impl_.state_.controllable());
  for (const Command& command : commands_) {
    const auto good = destination_question(command) ? forecast.go_to(destination_) : forecast.add(command);
    if (!good) return good;
  }
  const Positions begin = positions_of(impl_.state_);
  live_->ends_where_it_began = std::ranges::any_of(commands_, [](const Command& command) {
    return command.row->reg == Register::e || command.row->reg == Register::ep;
  });
  for (auto& result : live_->motion.results) {
    const auto place = static_cast<std::size_t>(result.axis - 1);
    if (forecast.at()[place] != begin[place]) live_->ends_where_it_began = false;
    result.target_pulses = forecast.at()[static_cast<std::size_t>(result.axis - 1)];
  }
  return {};
}

Task<Result<void>> Transaction::ask_for_destination() {
  const auto question = destination_question(commands_.front());
  if (!question) co_return Result<void>();
  const auto told = co_await impl_.ask_for_position(live_, *question);
  if (!told) co_return tl::unexpected(told.error());
  if (told->empty()) {
    const auto why = co_await impl_.explain_refused_question(*question, request_.context.who);
    co_return tl::unexpected(why ? *why : nothing_saved(*question));
  }
  for (const auto& [axis, pulses] : *told) destination_[static_cast<std::size_t>(axis - 1)] = pulses;
  co_return Result<void>();
}

Task<Result<void>> Transaction::begin() {
  auto ready = co_await impl_.enter_gate(live_, completes(commands_));
  if (!ready) co_return ready;
  ready = co_await impl_.learn_settings(commands_, request_.context.who);
  if (!ready) co_return ready;
  // Their speeds have to be known, to be set back.
  const AxisSet sped = axes_sped(commands_, SetsSpeeds::of_motion, impl_.state_.controllable());
  // DS: and the like set a part of what is pending.
  if (live_->motion.axes.empty()) co_await impl_.restore_pending_speeds(sped, request_.context.who);
  if (!sped.empty()) {
    const auto learned = co_await impl_.learn_speeds(sped, request_.context.who);
    // D: by itself is how impossible ones are mended.
    if (!learned && !live_->motion.axes.empty()) co_return learned;
  }
  if (leaves_host(commands_) && !impl_.line_works()) {
    co_return tl::unexpected(impl_.not_up());
  }
  if (live_->motion.axes.empty()) co_return check_envelope();
  Register reg = Register::none;
  for (const Command& command : commands_) {
    if (command.row->reg != Register::none) reg = command.row->reg;
  }
  ready = co_await impl_.prepare(live_, reg);
  if (ready) ready = co_await ask_for_destination();
  if (!ready) co_return ready;
  co_return check_envelope();
}

ExchangeRequest Transaction::request_for(const Command& command) {
  ExchangeRequest request;
  request.command = as_sent(command);
  request.lane = live_ ? Lane::motion : command.row->effect == Effect::question ? Lane::question : Lane::motion;
  request.caller = request_.context.who;
  request.not_after = request_.context.not_after;
  if (impl_.away_) request.not_after = std::max(request.not_after, impl_.now_ + kStepWriteLimit);  // it must come back
  request.motion = live_ ? live_->motion.id : 0;
  if (!live_) {
    request.lease = request_.context.lease;
    request.uses = axes_used({command}, impl_.state_.controllable());
  }
  const bool waits = command.row->reg != Register::none;  // its end tells no number of its own that is documented
  if (command.row->moves() && !waits && completes(commands_)) request.completes = live_->motion.axes;
  return request;
}

// In a chain completions follow one another, so nothing can be told apart before its end.
bool Transaction::single_motion() const {
  return std::ranges::none_of(impl_.live_, [](const auto& entry) {
    const MotionKind kind = entry.second->motion.kind;
    return kind == MotionKind::path || kind == MotionKind::execute || entry.second->chains;
  });
}

Task<ExchangeResult> Transaction::exchange(const Command& command) {
  const bool closed = command.row->separation == Separation::closed && single_motion();
  const auto note = [this](const std::vector<int>& completions) {
    for (const int axis : completions) impl_.note_completion(axis, true, true, impl_.now_);
  };
  std::optional<int> before;
  ClosedAnswers answers;
  ExchangeResult result;
  for (int attempt = 0; attempt < kClosedQuestionTries; ++attempt) {
    auto request = request_for(command);
    request.closed = closed;
    auto pending = impl_.line_.exchange(std::move(request), impl_.now_);
    result = co_await pending;
    const auto& numbers = result.candidates;
    if (numbers.empty() || !guarded(Guard::two_answers_agree)) {
      const auto certain = result.reply ? parse_integer(result.reply->text) : std::nullopt;
      if (certain && !result.problem) note(answers.settle(static_cast<int>(*certain)));
      co_return result;
    }
    note(answers.take(numbers));
    // Among numbers of several axes the answer may be any of them, and be missing.
    const bool alone = std::ranges::count(numbers, numbers.front()) == std::ssize(numbers);
    if (!alone && guarded(Guard::answers_come_alone)) {
      before.reset();
      continue;
    }
    const int answer = numbers.front();
    if (std::exchange(before, answer) != answer) continue;
    result.reply->text = std::to_string(answer);
    result.candidates.clear();
    note(answers.settle(answer));
    co_return result;
  }
  result.problem = Problem{.reason = Reason::completion_outstanding,
                           .message = "the answer could not be told from an axis number",
                           .hint = "ask again once the motion has ended",
                           .sent = command.line};
  co_return result;
}

Task<bool> Transaction::send(std::size_t index) {
  const Command& command = commands_[index];
  ExecuteEvent event;
  event.line = index;
  event.sent = as_sent(command).line;
  if (live_) live_->wrote = true;
  if (command.row->enters && !impl_.away_) impl_.leave_host(live_->motion.id);
  if (const auto known = co_await impl_.read_switches_before(live_, audit_, command); !known) {
    end(known.error());
    co_return false;
  }
  if (command.row->enters == Mode::host) co_await impl_.read_switches_left(live_, audit_);
  impl_.remember_settings(request_.context, command);
  const auto result = co_await exchange(command);
  impl_.note_setting(command, result);
  if (trigger_of(command) && result.accepted()) impl_.pending_restores_.forget_scan();
  if (command.row->moves()) {
    started_ = started_ || result.accepted();
    start_in_doubt_ = start_in_doubt_ || result.in_doubt();
  }
  if (command.row->moves() && result.accepted()) impl_.mark_running(live_);
  const AxisSet sped = axes_sped({command}, SetsSpeeds::of_motion, impl_.state_.controllable());
  impl_.forget_speeds(sped);
  // A setting of somebody's own takes the place of what was pending there.
  if (result.accepted() || result.in_doubt()) impl_.pending_restores_.forget_speeds(sped);
  // Also where the answer was lost: it may have been taken.
  if (command.row->shifts_frame && !result.refused()) impl_.frame_shifted(command.axes(impl_.state_.controllable()));
  if (command.row->enters && (result.accepted() || result.in_doubt())) {
    impl_.away_ = *command.row->enters;
    switches_ = switches_ || impl_.away_ == Mode::memory_switches;
  }
  if (command.row->rescales && !result.refused()) rescaled_ = true;
  if (command.row->restarts && (result.accepted() || result.in_doubt())) restarted_ = true;
  if (command.row->reg == Register::wi && !result.refused()) {
    for (const int axis : command.axes(impl_.state_.controllable()).list()) {
      impl_.state_.axis(axis).armed = waits_of(command).set;
    }
    impl_.publish_state();
  }
  if (result.problem) {
    end(result.problem);
    co_return false;
  }
  event.wire_reply = result.reply->text;
  event.answer = picked(command, *result.reply, impl_.state_.controllable());
  tell_(event);
  if (command.row->effect == Effect::question) {
    const bool good = co_await answered(command, result.refused());
    co_return good;
  }
  if (result.accepted()) {
    const bool program = command.row->moves() && command.row->needs.mode == Mode::program;
    if (program) {
      const auto ended = co_await impl_.wait_for_program(live_);
      if (!ended) end(ended.error());
      co_return ended.has_value();
    }
    co_return true;
  }
  auto why = co_await impl_.explain_refusal(command, command.axes(impl_.state_.controllable()), request_.context.who);
  end(std::move(why));
  co_return false;
}

// NG to a question is its answer where nothing says why.
Task<bool> Transaction::answered(Command question, bool refused) {
  if (!refused) co_return true;
  const bool saved = question.row->meaning == Meaning::saved_position;
  auto why = co_await impl_.explain_refused_question(question, request_.context.who);
  if (!why && saved) why = nothing_saved(question);
  if (!why) co_return true;
  end(std::move(why));
  co_return false;
}

Task<bool> Transaction::send_all() {
  for (std::size_t index = 0; index < commands_.size(); ++index) {
    const CommandRow& row = *commands_[index].row;
    const bool goes_on = started_ && !row.moves() && row.effect != Effect::motion_setting;
    if (live_ && live_->stop_requested && !goes_on) {
      end(Problem{.reason = Reason::stopped, .message = "stopped by " + live_->stopped_by});
      co_return false;
    }
    const bool sent = co_await send(index);
    if (!sent) co_return false;
  }
  co_return true;
}

// What its lines may have left otherwise than it is known. A pulse is another way after S: (manual 55)).
Task<Result<void>> Transaction::read_what_is_set() {
  if (rescaled_ && !live_->line_lost) {
    const auto read = co_await impl_.read_scales(request_.context.who);
    if (!read && !live_->line_lost) impl_.line_.give_up("its scale was changed, and could not be read", impl_.now_);
  }
  const AxisSet all = impl_.state_.controllable();
  if (impl_.known_origin_speeds(all).size() == static_cast<std::size_t>(all.count())) co_return Result<void>();
  auto read = co_await impl_.read_origin_speeds(request_.context.who);
  co_return read;
}

Task<void> Transaction::run() {
  if (needs_gate(commands_)) {
    const AxisSet axes = axes_moved(commands_, impl_.state_.controllable());
    live_ = impl_.create_motion(MotionKind::execute, axes, request_.context, {});
    live_->uses = axes_used(commands_, impl_.state_.controllable());
    live_->needs_excitation =
        std::ranges::any_of(commands_, [](const Command& command) { return command.row->needs.excited; });
    const auto begun = co_await begin();
    if (!begun) {
      end(begun.error());
      impl_.end_motion(live_, begun.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
                       begun.error());
      co_return;
    }
    live_->on_completion = [this](int axis) {
      ExecuteEvent event;
      event.kind = ExecuteEvent::Kind::completion;
      event.axis = axis;
      tell_(event);
    };
  } else if (const auto learned = co_await impl_.learn_settings(commands_, request_.context.who); !learned) {
    end(learned.error());
    co_return;
  }
  const bool all = co_await send_all();
  if (!live_) {
    if (all) end({});
    co_return;
  }
  if (impl_.away_) {
    co_await impl_.read_switches_left(live_, audit_);
    co_await impl_.come_back(live_, all, switches_);
    if (const auto changed = audit_.result(request_.context.who)) impl_.emit(*changed);
    if (all) end({});
    live_->on_completion = {};
    co_return;
  }
  if (restarted_) {
    impl_.line_.give_up("it was reset, and is looked at anew", impl_.now_);
    impl_.end_motion(live_, MotionState::succeeded, {});
    if (all) end({});
    live_->on_completion = {};
    co_return;
  }
  const bool wait = all && completes(commands_);
  if (all && !wait) {
    end({});
    live_->on_completion = {};
  }
  if (guarded(Guard::registers_unknown_after_transaction)) impl_.registers_.forget();
  if (started_ || start_in_doubt_) {
    co_await impl_.watch(live_, start_in_doubt_);
    if (!impl_.speeds_known()) co_await impl_.read_speeds(request_.context.who);
  } else {
    auto reread = co_await read_what_is_set();
    if (reread) reread = co_await impl_.read_speeds(request_.context.who);
    if (reread) reread = co_await impl_.read_excitation(request_.context.who);
    if (reread) reread = co_await impl_.read_positions(Lane::motion, request_.context.who);
    impl_.end_motion(live_, all && reread ? MotionState::succeeded : MotionState::failed, {});
  }
  if (wait) end(live_->motion.state == MotionState::succeeded ? std::nullopt : live_->motion.problem);
  live_->on_completion = {};
}

}  // namespace

Task<void> Controller::Impl::run_transaction(ExecuteRequest request, std::vector<Command> commands, OnExecute event) {
  Transaction transaction(*this, std::move(request), std::move(commands), std::move(event));
  co_await transaction.run();
}

}  // namespace axisgate::shrc203
