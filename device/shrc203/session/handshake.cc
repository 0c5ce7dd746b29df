#include "device/shrc203/session/handshake.h"

#include <fmt/format.h>

#include <string>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/answers.h"
#include "device/shrc203/session/non_host_visit.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

// Disconnects and returns false if the unit is neither the configured one nor, without configuration, the first that
// passed a handshake.
bool Handshake::is_expected(const Identity& identity) {
  if (!guarded(Guard::serial_number) || store_.is_expected(identity)) return true;
  const Profile& profile = store_.profile();
  const bool as_configured = !profile.serial_number.empty() || store_.unit().empty();
  const bool stop_open = !store_.state().open_stops.empty();
  const std::string why =
      fmt::format("{} {} answers, but {} {} {}{}", escaped(identity.model), escaped(identity.serial_number),
                  model().name(), store_.expected_unit(), as_configured ? "is configured" : "was connected before",
                  stop_open ? "; it may have received the open stop, and receives no further stops" : "");
  stop_writer_.other_unit_answered();
  line_.disconnect(why, tasks_.now());
  store_.note_trouble(LinkTrouble::other_unit);
  return false;
}

Task<void> Handshake::run(Identity identity, std::uint64_t connection) {
  if (!is_expected(identity)) co_return;
  store_.identified(identity);
  const bool host = co_await wait_for_host_mode(connection);
  if (!host) co_return;
  const bool ready = co_await wait_until_all_ready(connection);
  if (!ready) co_return;
  const bool read = co_await settings_.read(connection);
  if (connection != store_.connection()) co_return;
  if (!read) {
    line_.disconnect("the handshake failed", tasks_.now());
    co_return;
  }
  if (store_.begin_epoch() > 1) permission_.device_restarted(tasks_.now());
  store_.shift_frame(kAllAxes);
  if (guarded(Guard::registers_unknown_after_connect)) registers_.forget();
  line_.open(store_.controllable(), tasks_.now());
  motions_.pace_changed().notify();
  store_.publish();
}

// Returns nullopt if another connection has begun.
Task<std::optional<FrontPanelRead>> Handshake::read_panel(std::uint64_t connection) {
  const auto mode = co_await dialogue_.ask(Dialogue::Question::mode, Lane::question, kGateway, true);
  if (connection != store_.connection()) co_return std::nullopt;
  if (!is_data(mode)) co_return FrontPanelRead::unreadable;
  store_.note_mode(mode.reply->text);
  const bool host = store_.state().mode == "HOST";
  if (host && store_.trouble() == LinkTrouble::mode) store_.note_trouble(LinkTrouble::line);
  if (!host && guarded(Guard::host_mode)) co_return FrontPanelRead::wrong;
  non_host_.returned();
  const auto format = co_await dialogue_.ask(Dialogue::Question::format, Lane::question, kGateway, true);
  if (connection != store_.connection()) co_return std::nullopt;
  store_.note_format(is_data(format) ? format.reply->text : "");
  if (store_.trouble() == LinkTrouble::format) store_.note_trouble(LinkTrouble::line);
  if (store_.state().format == "SHOT_FC" || !guarded(Guard::host_mode)) co_return FrontPanelRead::fit;
  co_return is_data(format) ? FrontPanelRead::wrong : FrontPanelRead::format_unreadable;
}

// Waits until the controller is in HOST mode with the SHOT_FC format. The gateway never switches the mode or the
// dialect that was chosen at the front panel.
Task<bool> Handshake::wait_for_host_mode(std::uint64_t connection) {
  for (int failures = 0; connection == store_.connection() && failures < kHandshakeTries;) {
    const auto panel = co_await read_panel(connection);
    if (!panel) co_return false;
    if (*panel == FrontPanelRead::fit) co_return true;
    if (*panel != FrontPanelRead::wrong) ++failures;
    if (*panel == FrontPanelRead::unreadable) continue;
    store_.note_wrong_panel();
    store_.publish();
    co_await come_back();
    auto pause = tasks_.pause(kHandshakeModePoll);
    co_await pause;
  }
  if (connection == store_.connection()) line_.disconnect("the handshake failed: no answer to ?:MODE", tasks_.now());
  co_return false;
}

// Ends an interrupted visit to a non-host mode: returns to HOST, and ends the program.
Task<void> Handshake::come_back() {
  if (!non_host_.away()) co_return;
  if (store_.state().mode == "HOST,PROGRAM") {
    (void)co_await dialogue_.ask(commands::stop_program(), Lane::question, "the gateway", true);
  }
  (void)co_await step_to_host(dialogue_, store_, Lane::question, "the gateway", true);
}

// Waits until all axes are READY. It is unknown what was left running, so every completion is possible until the first
// !:S with only R, and 200 ms of quiet after it.
Task<bool> Handshake::wait_until_all_ready(std::uint64_t connection) {
  int failures = 0;
  while (connection == store_.connection() && failures < kHandshakeTries) {
    const auto ready = co_await dialogue_.ask(Dialogue::Question::each_ready, Lane::question, kGateway, true);
    if (connection != store_.connection()) co_return false;
    if (!is_data(ready)) {
      ++failures;
      continue;
    }
    const bool busy = ready.reply->text.find('B') != std::string::npos && guarded(Guard::ready_before_open);
    if (!busy) {
      previous_run_.all_stationary();
      line_.ready(kAllAxes, tasks_.now());
      auto quiet = tasks_.pause(kNoCompletionAfterReady);
      co_await quiet;
      co_return connection == store_.connection();
    }
    co_await wait_for_others();
  }
  if (connection == store_.connection()) line_.disconnect("the handshake failed: no answer to !:S", tasks_.now());
  co_return false;
}

std::string_view Handshake::origin_of_motion() const {
  if (!store_.left_moving().empty()) return "the gateway had started before it ended";
  return store_.state().moving_unknown ? "the gateway had started before the line was lost"
                                       : "the gateway did not start";
}

Task<void> Handshake::wait_for_others() {
  line_.busy(kAllAxes, tasks_.now());
  stops_.axes_move();
  store_.note_trouble(LinkTrouble::motion,
                      fmt::format("something moves that {}; waiting until it is stationary", origin_of_motion()));
  const auto read = co_await reader_.read_positions(Lane::question, kGateway, true);
  if (!read) store_.publish();
  auto pause = tasks_.pause(kHandshakeReadyPoll);
  co_await pause;
}

}  // namespace axisgate::shrc203
