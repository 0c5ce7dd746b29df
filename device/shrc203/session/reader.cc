#include "device/shrc203/session/reader.h"

#include <fmt/format.h>

#include <chrono>
#include <string_view>
#include <utility>

#include "device/core/guard.h"
#include "device/shot/command/trigger_reply.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

// Highest speed of any axis (manual 89) D:). A reading that implies a greater one is read again before it is accepted.
constexpr double kPulsesPerSecondMax = 1'000'000;
constexpr std::int64_t kJumpMargin = 10'000;

Problem unreadable(commands::Question question, const ExchangeResult& result) {
  const std::string_view sent = commands::text(question);
  return {.reason = Reason::device_refused,
          .message = fmt::format("{} was answered by {}", sent, result.reply->text),
          .hint = "check the controller's mode",
          .sent = std::string(sent),
          .wire_reply = result.reply->text};
}

}  // namespace

// Reports whether an axis would have moved faster than any axis can.
bool Reader::implausible(const Reply& reply) const {
  const Positions before = store_.positions();
  const auto readings = parse_positions(model(), reply, store_.controllable());
  if (!readings) return false;
  const double seconds = std::chrono::duration<double>(tasks_.now() - store_.state().read).count();
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    if (!before[i] || !(*readings)[i].valid) continue;
    const auto distance = (*readings)[i].pulses - *before[i];
    const double length = static_cast<double>(distance < 0 ? -distance : distance);
    if (length > seconds * kPulsesPerSecondMax + static_cast<double>(kJumpMargin)) return true;
  }
  return false;
}

Task<Result<void>> Reader::read_positions(Lane lane, std::string caller, bool in_handshake) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto result = co_await dialogue_.ask(Dialogue::Question::positions, lane, caller, in_handshake);
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (result.reply->kind != Reply::Kind::data) {
      if (!in_handshake) panel_.position_refused();
      co_return tl::unexpected(unreadable(Dialogue::Question::positions, result));
    }
    // The second reading is always accepted: origin returns and presets cause real jumps.
    if (attempt == 0 && implausible(*result.reply) && guarded(Guard::jumps_read_again)) continue;
    if (apply_positions(*result.reply)) co_return Result<void>();
  }
  co_return fail(Reason::line_fault, "the positions read make no sense", "check the cable and the line settings");
}

void Reader::note_positions(const Reply& reply) {
  if (reply.kind == Reply::Kind::data && !implausible(reply)) apply_positions(reply);
}

// Returns the axes that move as requested and will not send a completion.
AxisSet Reader::moving_silently() const { return motions_.running() - line_.completions().possible(); }

bool Reader::apply_positions(const Reply& reply) {
  const auto read = store_.note_positions(reply);
  if (!read) return false;
  line_.ready(read->ready | (kAllAxes - store_.controllable()), tasks_.now());
  line_.busy(read->busy - moving_silently(), tasks_.now());
  store_.note_foreign_motion(read->busy, motions_.inside());
  motions_.seen_stationary(read->ready);
  store_.publish();
  return true;
}

Task<Result<void>> Reader::read_registers(std::string caller) {
  Registers::Reading reading = registers_.begin_reading();
  for (const Register reg : Registers::all()) {
    const Dialogue::Question question = commands::question_of(reg);
    const auto result = co_await dialogue_.ask(question, Lane::motion, caller);
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(question, result));
    reading.take(reg, *result.reply, store_.controllable());
  }
  registers_.end_reading(std::move(reading));
  co_return Result<void>();
}

Task<Result<void>> Reader::read_speeds(std::string caller) {
  const auto result = co_await dialogue_.ask(Dialogue::Question::speeds, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data) co_return tl::unexpected(unreadable(Dialogue::Question::speeds, result));
  for (const auto& [axis, field] : by_axis(model(), *result.reply, store_.controllable())) {
    if (const auto speed = parse_speed_setting(field)) store_.note_speeds({{axis, *speed}});
  }
  co_return Result<void>();
}

Task<Result<void>> Reader::read_scales(std::string caller) {
  std::string before;
  for (int attempt = 0; attempt < kAgreeingAnswerTries; ++attempt) {
    const auto result = co_await dialogue_.ask(Dialogue::Question::pulse_length, Lane::motion, caller);
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (result.reply->kind != Reply::Kind::data)
      co_return tl::unexpected(unreadable(Dialogue::Question::pulse_length, result));
    if (std::exchange(before, result.reply->text) != result.reply->text) continue;
    for (const auto& [number, field] : by_axis(model(), *result.reply, store_.controllable())) {
      const auto per_pulse = parse_decimal(field);
      auto scale = store_.state().axis(number).scale;
      if (!per_pulse || per_pulse->digits == 0 || !scale) continue;
      scale->per_pulse = *per_pulse;
      store_.note_scale(number, *scale);
    }
    store_.note_reported_scales(result.reply->text);
    co_return Result<void>();
  }
  co_return fail(Reason::line_fault, "each reading of `?:P` shows another resolution", "check the cable");
}

Task<Result<void>> Reader::read_origin_speeds(std::string caller) {
  const auto result = co_await dialogue_.ask(Dialogue::Question::origin_speeds, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data)
    co_return tl::unexpected(unreadable(Dialogue::Question::origin_speeds, result));
  for (const auto& [axis, field] : by_axis(model(), *result.reply, store_.controllable())) {
    store_.note_origin_speeds(axis, parse_speed_setting(field));
  }
  co_return Result<void>();
}

Task<Result<void>> Reader::read_excitation(std::string caller, Lane lane) {
  const auto result = co_await dialogue_.ask(Dialogue::Question::excitation, lane, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data)
    co_return tl::unexpected(unreadable(Dialogue::Question::excitation, result));
  store_.note_excitation(by_axis(model(), *result.reply, store_.controllable()));
  store_.publish();
  co_return Result<void>();
}

bool Reader::may_poll_excitation() const {
  return store_.controllable().count() > 1 || line_.completions().possible().empty();
}

Task<Result<void>> Reader::read_outputs(std::string caller) {
  const auto result = co_await dialogue_.ask(Dialogue::Question::outputs, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data)
    co_return tl::unexpected(unreadable(Dialogue::Question::outputs, result));
  store_.note_outputs(static_cast<int>(*parse_integer(result.reply->text)));
  store_.publish();
  co_return Result<void>();
}

Task<Result<void>> Reader::read_trigger(std::string caller) {
  const auto result = co_await dialogue_.ask(Dialogue::Question::trigger, Lane::motion, std::move(caller));
  if (result.problem) co_return tl::unexpected(*result.problem);
  if (result.reply->kind != Reply::Kind::data)
    co_return tl::unexpected(unreadable(Dialogue::Question::trigger, result));
  store_.note_trigger(parse_trigger(result.reply->text, model().axes()));
  store_.publish();
  co_return Result<void>();
}

Task<Result<void>> Reader::learn_speeds(AxisSet axes, std::string caller) {
  const auto missing = [&] { return store_.speeds(axes).size() < static_cast<std::size_t>(axes.count()); };
  for (int attempt = 0; attempt < kSettingReadTries && missing(); ++attempt) {
    const auto read = co_await read_speeds(caller);
    if (!read) co_return read;
  }
  if (!missing()) co_return Result<void>();
  co_return fail(Reason::line_fault, "the speeds of the axes were read as ones that no axis can have",
                 "check them: `Execute` ?:D; set them: `Execute` D:...");
}

}  // namespace axisgate::shrc203
