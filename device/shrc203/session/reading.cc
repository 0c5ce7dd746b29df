// Questions of the gateway's own: positions, registers, speeds, and why the controller said NG.
#include <fmt/format.h>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

// Faster than this no axis runs (manual 89) D:); a reading beyond it is read again before it is believed.
constexpr double kPulsesPerSecondMax = 1'000'000;
constexpr std::int64_t kJumpMargin = 10'000;

Problem unreadable(commands::Question question, const ExchangeResult& result) {
  const std::string_view sent = commands::text(question);
  return {.reason = Reason::device_refused,
          .message = fmt::format("{} was answered by {}", sent, result.reply->text),
          .hint = "look at the controller's mode",
          .sent = std::string(sent),
          .wire_reply = result.reply->text};
}

}  // namespace

Task<ExchangeResult> Controller::Impl::ask(Command command, Lane lane, std::string caller, bool in_handshake) {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = lane;
  request.caller = std::move(caller);
  request.not_after = now_ + kStepWriteLimit;
  request.handshake = in_handshake;
  auto pending = line_.exchange(std::move(request), now_);
  auto result = co_await pending;
  co_return result;
}

Task<Result<Reply>> Controller::Impl::ask_twice(LiveMotionPtr live, Command question) {
  std::string before;
  for (int telling = 0; telling < kAgreeingAnswerTries; ++telling) {
    auto request = motion_request(*live, question, Lane::motion);
    request.not_after = now_ + kStepWriteLimit;
    auto pending = line_.exchange(std::move(request), now_);
    const auto result = co_await pending;
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (telling > 0 && before == result.reply->text) co_return *result.reply;
    before = result.reply->text;
  }
  co_return fail(Reason::line_fault, fmt::format("{} is answered otherwise every time", question.line),
                 "check the cable");
}

Task<Result<void>> Controller::Impl::read_positions(Lane lane, std::string caller, bool in_handshake) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    ExchangeRequest request;
    request.command = commands::ask(Question::positions);
    request.lane = lane;
    request.caller = caller;
    request.not_after = now_ + kStepWriteLimit;
    request.handshake = in_handshake;
    auto pending = line_.exchange(std::move(request), now_);
    const auto result = co_await pending;
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (result.reply->kind != Reply::Kind::data) {
      if (!in_handshake) executor_.spawn(follow_mode());
      co_return tl::unexpected(unreadable(Question::positions, result));
    }
    // The second reading is believed whatever it says: origin returns and presets make true jumps.
    const Positions before = positions_of(state_);
    const TimePoint read_before = state_.read;
    const auto readings = parse_positions(*result.reply, state_.controllable());
    bool jumps = false;
    for (std::size_t i = 0; readings && i < kAxisCount; ++i) {
      if (!before[i] || !(*readings)[i].valid) continue;
      const double seconds = std::chrono::duration<double>(now_ - read_before).count();
      const auto way = (*readings)[i].pulses - *before[i];
      jumps = jumps || static_cast<double>(way < 0 ? -way : way) >
                           seconds * kPulsesPerSecondMax + static_cast<double>(kJumpMargin);
    }
    if (jumps && attempt == 0 && guarded(Guard::jumps_read_again)) continue;
    if (apply_positions(*result.reply)) co_return Result<void>();
  }
  co_return fail(Reason::line_fault, "the positions read make no sense", "check the cable and the line settings");
}

// Axes that move as asked and will not tell when they stand.
AxisSet Controller::Impl::moving_silently() {
  AxisSet moving;
  for (const auto& [id, live] : live_) {
    if (live->motion.state != MotionState::queued) moving = moving | live->motion.axes;
  }
  return moving - line_.completions().possible();
}

bool Controller::Impl::apply_positions(const Reply& reply) {
  const auto readings = parse_positions(reply, state_.controllable());
  if (!readings) return false;
  AxisSet ready, busy;
  for (const int number : AxisSet::all().list()) {
    const auto& reading = (*readings)[static_cast<std::size_t>(number - 1)];
    auto& axis = state_.axis(number);
    if (!reading.valid) continue;
    axis.position_pulses = reading.pulses;
    axis.status = reading.status;
    axis.busy = reading.busy;
    (reading.busy ? busy : ready).add(number);
  }
  line_.ready(ready | (AxisSet::all() - state_.controllable()), now_);
  line_.busy(busy - moving_silently(), now_);
  state_.read = now_;
  if (busy.empty()) state_.moving_unknown = false;
  tell_foreign_motion(busy);
  publish_state();
  return true;
}

// One flipped bit makes a B of an R, so two readings must say it.
void Controller::Impl::tell_foreign_motion(AxisSet busy) {
  AxisSet ours = state_.moving_unknown ? AxisSet::all() : AxisSet();
  for (const auto& [id, live] : live_) {
    if (live->inside_gate) ours = ours | live->motion.axes;
  }
  const AxisSet strange = guarded(Guard::foreign_motion_told) ? busy - ours : AxisSet();
  AxisSet told;
  for (const int number : AxisSet::all().list()) {
    bool& foreign = state_.axis(number).foreign_motion;
    const bool now = strange.has(number) && (foreign || strange_before_.has(number));
    if (now && !foreign) told.add(number);
    foreign = now;
  }
  strange_before_ = strange;
  if (!told.empty()) emit(ForeignMotion{told});
}

Task<Result<void>> Controller::Impl::read_registers(std::string caller) {
  Registers::Reading reading = registers_.begin_reading();
  for (const Register reg : Registers::all()) {
    const Question question = commands::question_of(reg);
    const auto result = co_await ask(question, Lane::motion, caller);
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(question, result));
    reading.take(reg, *result.reply, state_.controllable());
  }
  registers_.end_reading(std::move(reading));
  co_return Result<void>();
}

Task<Result<void>> Controller::Impl::read_speeds(std::string caller) {
  const auto result = co_await ask(Question::speeds, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(Question::speeds, result));
  for (const auto& [axis, field] : by_axis(*result.reply, state_.controllable())) {
    if (const auto speed = parse_speed_setting(field)) note_speeds({{axis, *speed}});
  }
  co_return Result<void>();
}

// After S: (manual 55)). Twice, since everything hangs on it.
Task<Result<void>> Controller::Impl::read_scales(std::string caller) {
  std::string before;
  for (int attempt = 0; attempt < kAgreeingAnswerTries; ++attempt) {
    const auto result = co_await ask(Question::pulse_length, Lane::motion, caller);
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(Question::pulse_length, result));
    if (std::exchange(before, result.reply->text) != result.reply->text) continue;
    for (const auto& [number, field] : by_axis(*result.reply, state_.controllable())) {
      const auto per_pulse = parse_decimal(field);
      auto& scale = state_.axis(number).scale;
      if (per_pulse && per_pulse->digits != 0 && scale) scale->per_pulse = *per_pulse;
    }
    scale_told_ = result.reply->text;
    co_return Result<void>();
  }
  co_return fail(Reason::line_fault, "what a pulse is, is told otherwise every time", "check the cable");
}

Task<Result<void>> Controller::Impl::read_origin_speeds(std::string caller) {
  const auto result = co_await ask(Question::origin_speeds, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(Question::origin_speeds, result));
  for (const auto& [axis, field] : by_axis(*result.reply, state_.controllable())) {
    note_origin_speeds(axis, parse_speed_setting(field));
  }
  co_return Result<void>();
}

// The front panel and an emergency stop switch motors too, so what is known is asked again where it matters.
Task<Result<void>> Controller::Impl::read_excitation(std::string caller) {
  const auto result = co_await ask(Question::excitation, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(Question::excitation, result));
  for (const auto& [axis, field] : by_axis(*result.reply, state_.controllable())) {
    state_.axis(axis).excited = field == "1";
  }
  publish_state();
  co_return Result<void>();
}

Task<Result<void>> Controller::Impl::read_outputs(std::string caller) {
  const auto result = co_await ask(Question::outputs, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(Question::outputs, result));
  state_.outputs = static_cast<int>(*parse_integer(result.reply->text));
  publish_state();
  co_return Result<void>();
}

Task<Result<void>> Controller::Impl::read_trigger(std::string caller) {
  const auto result = co_await ask(Question::trigger, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(Question::trigger, result));
  state_.trigger = parse_trigger(result.reply->text);
  publish_state();
  co_return Result<void>();
}

Task<void> Controller::Impl::refresh(Duration max_age, RequestContext context, OnState done) {
  if (away_) {
    done(tl::unexpected(away_problem()));
    co_return;
  }
  if (state_.link != LinkState::up && state_.link != LinkState::doubtful) {
    done(tl::unexpected(not_up()));
    co_return;
  }
  if (state_.read == TimePoint{} || now_ - state_.read > max_age) {
    const auto read = co_await read_positions(Lane::question, context.who);
    if (!read) {
      done(tl::unexpected(read.error()));
      co_return;
    }
  }
  done(state_);
}

void Controller::Impl::publish_state() { emit(StateChanged{}); }

}  // namespace axisgate::shrc203
