// Who is there after a connect, and the poll that keeps the state fresh afterwards.
#include <fmt/format.h>

#include <algorithm>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {
namespace {

bool is_data(const ExchangeResult& result) {
  return result.reply && !result.problem && result.reply->kind == Reply::Kind::data;
}

}  // namespace

Task<void> Controller::Impl::handshake(Identity identity, std::uint64_t connection) {
  const bool configured = !profile_.serial_number.empty();
  const std::string& serial_number = configured ? profile_.serial_number : unit_;
  const bool wrong_serial = !serial_number.empty() && identity.serial_number != serial_number;
  if (guarded(Guard::serial_number) && (identity.model != profile_.model || wrong_serial)) {
    line_.give_up(
        fmt::format("{} {} answers, but {} {} {}", escaped(identity.model), escaped(identity.serial_number),
                    profile_.model, serial_number, configured || unit_.empty() ? "is configured" : "was here before"),
        now_);
    co_return;
  }
  state_.vendor = identity.vendor;
  state_.model = identity.model;
  state_.serial_number = identity.serial_number;
  state_.firmware = identity.firmware;
  const bool host = co_await wait_for_host_mode(connection);
  if (!host) co_return;
  const bool ready = co_await wait_until_all_ready(connection);
  if (!ready) co_return;
  const bool read = co_await read_settings(connection);
  if (!read || connection != connection_) {
    if (connection == connection_) line_.give_up("the handshake failed", now_);
    co_return;
  }
  if (++state_.device_epoch > 1) permission_.device_restarted(now_);
  state_.epoch_began = now_;
  frame_shifted(AxisSet::all());
  if (guarded(Guard::registers_unknown_after_connect)) registers_.forget();
  unit_ = state_.serial_number;
  line_.open(state_.controllable(), now_);
  wake_poll_.notify();
  publish_state();
}

// Whether somebody must put it right at the front panel before the link can be up.
bool Controller::Impl::panel_is_wrong() const {
  return link_trouble_ == LinkTrouble::mode || link_trouble_ == LinkTrouble::format;
}

void Controller::Impl::note_wrong_panel() {
  if (state_.mode != "HOST") {
    note_link_problem(LinkTrouble::mode, fmt::format("the controller is in {} mode; HOST is needed", state_.mode));
  } else {
    note_link_problem(LinkTrouble::format, fmt::format("the command format is {}; SHOT_FC is needed", state_.format));
  }
}

Problem Controller::Impl::not_up() const {
  const bool panel = panel_is_wrong();
  return {.reason = panel ? Reason::wrong_mode : Reason::link_down,
          .message = "the device is not up: " + state_.link_problem,
          .hint = panel ? "put it right at the controller's front panel" : "try again when it is up"};
}

// The front panel chooses the mode and the dialect; neither is ever switched back from here.
Task<bool> Controller::Impl::wait_for_host_mode(std::uint64_t connection) {
  int failures = 0;
  while (connection == connection_ && failures < kHandshakeTries) {
    const auto mode = co_await ask(Question::mode, Lane::question, kGateway, true);
    if (connection != connection_) co_return false;
    if (!is_data(mode)) {
      ++failures;
      continue;
    }
    state_.mode = mode.reply->text;
    if (state_.mode == "HOST" && link_trouble_ == LinkTrouble::mode) link_trouble_ = LinkTrouble::line;
    if (state_.mode == "HOST" || !guarded(Guard::host_mode)) {
      away_.reset();
      const auto format = co_await ask(Question::format, Lane::question, kGateway, true);
      if (connection != connection_) co_return false;
      state_.format = is_data(format) ? format.reply->text : "";
      if (link_trouble_ == LinkTrouble::format) link_trouble_ = LinkTrouble::line;
      if (state_.format == "SHOT_FC" || !guarded(Guard::host_mode)) co_return true;
      if (!is_data(format)) ++failures;
    }
    note_wrong_panel();
    publish_state();
    co_await come_back_in_handshake();
    auto wait = tick_.wait_until(now_ + kHandshakeModePoll);
    co_await wait;
  }
  if (connection == connection_) line_.give_up("the handshake failed: no answer to ?:MODE", now_);
  co_return false;
}

// Nobody knows what was left running, so every axis number may still come (design: until the first !:S that is all R
// and 200 ms of quiet).
Task<bool> Controller::Impl::wait_until_all_ready(std::uint64_t connection) {
  int failures = 0;
  while (connection == connection_ && failures < kHandshakeTries) {
    const auto ready = co_await ask(Question::each_ready, Lane::question, kGateway, true);
    if (connection != connection_) co_return false;
    if (!is_data(ready)) {
      ++failures;
      continue;
    }
    const bool busy = ready.reply->text.find('B') != std::string::npos && guarded(Guard::ready_before_open);
    if (!busy) {
      runaways_ = {};
      line_.ready(AxisSet::all(), now_);
      auto quiet = tick_.wait_until(now_ + kCompletionAfterReadyMax + kCompletionAfterReadyMargin);
      co_await quiet;
      co_return connection == connection_;
    }
    line_.busy(AxisSet::all(), now_);
    stop_runaways();
    note_link_problem(LinkTrouble::motion, "something moves that the gateway did not start; waiting until it stands");
    const auto read = co_await read_positions(Lane::question, kGateway, true);
    if (!read) publish_state();
    auto wait = tick_.wait_until(now_ + kHandshakeReadyPoll);
    co_await wait;
  }
  if (connection == connection_) line_.give_up("the handshake failed: no answer to !:S", now_);
  co_return false;
}

Task<bool> Controller::Impl::read_settings(std::uint64_t connection) {
  // The axes are asked for twice: everything else hangs on that one digit, and a line can turn a 6 into a 2.
  ExchangeResult axes, axes_again, serial, scale, speeds, excitation, outputs, trigger, origin_speeds;
  struct Step {
    Question question;
    ExchangeResult* answer;
  };
  for (const Step step : {Step{Question::axes, &axes}, Step{Question::axes, &axes_again},
                          Step{Question::serial_number, &serial}, Step{Question::pulse_length, &scale},
                          Step{Question::speeds, &speeds}, Step{Question::excitation, &excitation}}) {
    for (int attempt = 0; attempt < kHandshakeTries && !is_data(*step.answer); ++attempt) {
      if (connection != connection_) co_return false;
      *step.answer = co_await ask(step.question, Lane::question, kGateway, true);
    }
    if (!is_data(*step.answer)) co_return false;
  }
  // Whoever sets these asks for them then, if need be.
  for (const Step step : {Step{Question::outputs, &outputs}, Step{Question::trigger, &trigger},
                          Step{Question::origin_speeds, &origin_speeds}}) {
    if (connection != connection_) co_return false;
    *step.answer = co_await ask(step.question, Lane::question, kGateway, true);
  }
  scale_told_ = scale.reply->text;
  state_.outputs.reset();
  if (is_data(outputs)) state_.outputs = static_cast<int>(*parse_integer(outputs.reply->text));
  state_.trigger = is_data(trigger) ? parse_trigger(trigger.reply->text) : std::nullopt;
  const auto controllable = from_axis_setting(axes.reply->text);
  const bool twice = axes_again.reply->text == axes.reply->text || !guarded(Guard::axes_twice);
  if (!controllable || !twice) co_return false;
  if (serial.reply->text != state_.serial_number && guarded(Guard::serial_number_twice)) co_return false;
  for (const int number : AxisSet::all().list()) state_.axis(number).controllable = controllable->has(number);
  const auto scales = by_axis(*scale.reply, *controllable), set_speeds = by_axis(*speeds.reply, *controllable),
             excited = by_axis(*excitation.reply, *controllable);
  for (const auto* fields : {&scales, &set_speeds, &excited}) {
    if (fields->size() != static_cast<std::size_t>(controllable->count())) co_return false;
  }
  const auto origins =
      is_data(origin_speeds) ? by_axis(*origin_speeds.reply, *controllable) : std::map<int, std::string>();
  for (const int number : controllable->list()) {
    auto& axis = state_.axis(number);
    const auto per_pulse = parse_decimal(scales.at(number));
    const auto speed = parse_speed_setting(set_speeds.at(number));
    if (!per_pulse || per_pulse->digits == 0 || !speed) co_return false;
    axis.scale = Scale{*per_pulse, profile_.axes[static_cast<std::size_t>(number - 1)].rotary()};
    note_speeds({{number, *speed}});
    note_origin_speeds(number, origins.contains(number) ? parse_speed_setting(origins.at(number)) : std::nullopt);
    axis.excited = excited.at(number) == "1";
    axis.armed = false;
  }
  const auto positions = co_await read_positions(Lane::question, kGateway, true);
  co_return positions.has_value();
}

// Polling is the net below the completions: slow when nothing moves.
Task<void> Controller::Impl::poll() {
  while (true) {
    const bool fast = anything_moves();
    auto wait = wake_poll_.wait_until(now_ + (fast ? profile_.moving_poll : profile_.idle_poll));
    co_await wait;
    if (state_.link != LinkState::up || away_) continue;
    const TimePoint read_before = state_.read;
    const bool watched = std::ranges::any_of(live_, [](const auto& entry) { return entry.second->watched; });
    if (watched) continue;  // its motion reads at the same pace
    const Duration interval = anything_moves() ? profile_.moving_poll : profile_.idle_poll;
    if (now_ - read_before < interval) continue;  // somebody has just asked
    const auto read = co_await read_positions(Lane::poll, kGateway);
    if (!read) publish_state();
  }
}

// A refused Q: means that somebody has changed the mode or the dialect at the front panel (hazard: the front panel
// leaves HOST).
Task<void> Controller::Impl::follow_mode() {
  if (away_) co_return;
  const std::uint64_t connection = connection_;
  const auto mode = co_await ask(Question::mode, Lane::question, kGateway, true);
  if (!is_data(mode) || connection != connection_) co_return;
  state_.mode = mode.reply->text;
  if (state_.mode == "HOST") {
    const auto format = co_await ask(Question::format, Lane::question, kGateway, true);
    if (!is_data(format) || connection != connection_) co_return;
    state_.format = format.reply->text;
  }
  if (state_.mode == "HOST" && state_.format == "SHOT_FC") co_return;
  note_wrong_panel();
  const LinkTrouble trouble = link_trouble_;
  line_.give_up(std::string(state_.link_problem), now_);
  link_trouble_ = trouble;
}

// After a restart every command counter shows 0 until something moves, and nothing is moved before this has been
// decided. Where all showed 0 before, nothing tells, and what is not known to be the same counts as another. Where only
// an answer was late, that would be a false alarm on every slow host: from 0 to 0 places are the same, if pulses are.
Task<void> Controller::Impl::look_for_restart(std::uint64_t connection) {
  const bool at_origin = std::ranges::all_of(
      state_.axes, [](const AxisState& axis) { return !axis.controllable || axis.position_pulses == 0; });
  Result<void> read;
  for (int attempt = 0; attempt < kHandshakeTries; ++attempt) {
    read = co_await read_positions(Lane::question, kGateway, true);
    if (connection != connection_) co_return;
    if (read) break;
  }
  const auto elsewhere = [this] {
    return std::ranges::any_of(
        state_.axes, [](const AxisState& axis) { return axis.controllable && axis.position_pulses.value_or(0) != 0; });
  };
  bool same = read && elsewhere();
  if (read && !same && at_origin && line_.restart_only_possible()) {
    const auto scale = co_await ask(Question::pulse_length, Lane::question, kGateway, true);
    if (connection != connection_) co_return;
    same = is_data(scale) && scale.reply->text == scale_told_;
  }
  if (!same) {
    line_.give_up("the controller seems to have restarted", now_);
    co_return;
  }
  line_.still_the_same(now_);
}

}  // namespace axisgate::shrc203
