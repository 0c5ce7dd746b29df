#include "device/shrc203/session/session.h"

#include <fmt/format.h>

#include <utility>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

void Session::line_opened(TimePoint) {
  show_link();
  const LinkState link = store_.state().link;
  if (link == LinkState::connecting) store_.emit(LinkChanged{link, "the line is open"});
  stops_.line_opened();
}

std::vector<ExchangeRequest> Session::stops_to_write(std::string_view heard, TimePoint) {
  if (!heard.empty() && !line_.state().trusted()) previous_run_.heard(heard);
  return stop_writer_.lines_due(heard);
}

void Session::line_trusted(TimePoint) {
  show_link();
  store_.note_trouble(LinkTrouble::none, "");
  stops_.line_answers();
  store_.emit(LinkChanged{LinkState::up, "", store_.controllable(), store_.state().serial_number});
}

void Session::same_controller(TimePoint) {
  show_link();
  stops_.line_answers();
}

void Session::line_connected(const Identity& identity, const std::optional<std::string>& line_before, TimePoint) {
  store_.connected();
  if (store_.is_expected(identity)) {
    previous_run_.identified(identity, line_before);
    stops_.line_answers();
  }
  tasks_.spawn(handshake_.run(identity, store_.connection()));
}

void Session::line_lost(const std::string& why, TimePoint) {
  if (guarded(Guard::registers_unknown_after_connect)) registers_.forget();
  const LinkState before = store_.state().link;
  show_link();
  const LinkState link = store_.state().link;
  const bool changed = before != link || store_.state().link_problem != why;
  store_.note_trouble(LinkTrouble::line, why);
  store_.lost();
  stops_.line_lost();
  stop_jogs();
  motions_.line_lost(why);
  if (!changed) return;
  store_.emit(LinkChanged{link, why});
  store_.publish();
}

// Stops all jogs, since a jog never ends by itself.
void Session::stop_jogs() {
  AxisSet axes;
  for (const auto& [id, live] : motions_.live()) {
    if (live->jog && live->life.has_written() && !live->life.has_outcome()) axes = axes | live->motion.axes;
  }
  if (axes.empty() || !guarded(Guard::orphans_stopped)) return;
  stops_.stop(axes, {.who = "the gateway (the line was lost during a jog)"});
}

void Session::barrier_entered(const std::string& why, TimePoint) {
  store_.unsettle();
  stops_.barrier_entered();
  show_link();
  store_.emit(BarrierEntered{why});
}

void Session::barrier_passed(const Identity& identity, TimePoint now) {
  show_link();
  stops_.line_answers();
  if (!line_.state().trusted()) return;
  const State& state = store_.state();
  const bool same = identity.serial_number == state.serial_number && identity.model == state.model;
  if (same || !guarded(Guard::serial_number_after_barrier)) return;
  line_.disconnect(fmt::format("another controller answers: {} {}", escaped(identity.model), identity.serial_number),
                   now);
}

void Session::restart_suspected(TimePoint) {
  store_.unsettle();
  show_link();
  tasks_.spawn(restart_check_.run(store_.connection()));
}

void Session::completion_seen(int axis, bool doubtful, TimePoint) {
  line_.completions().arrived(axis);
  motions_.completion_seen(axis, doubtful, false);
}

void Session::completion_deduced(int axis) {
  line_.completions().arrived(axis);
  motions_.completion_seen(axis, true, true);
}

void Session::line_event(const Event& event, TimePoint) {
  if (std::holds_alternative<IllegalTransition>(event)) {
    // The stop stays open when the line is disconnected, and is sent first on the next connection.
    stops_.stop(kAllAxes, {.who = kGateway});
  }
  const auto* notice = std::get_if<ProgramNotice>(&event);
  if (!notice || !guarded(Guard::notices_bounded)) return store_.emit(event);
  NoticeCount& count = notices_[notice->kind];
  ++count.untold;
  if (std::exchange(count.telling, true)) return;
  tasks_.spawn(tell_notices(notice->kind));
}

void Session::illegal(std::string_view machine, std::string_view state, std::string_view event) {
  line_event(IllegalTransition{machine, state, event}, tasks_.now());
  line_.disconnect(fmt::format("an internal error: {} in state {} cannot have the event {}", machine, state, event),
                   tasks_.now());
}

// Emits the first notice at once, and then those that arrived meanwhile as one event.
Task<void> Session::tell_notices(ProgramNotice::Kind kind) {
  NoticeCount& count = notices_[kind];
  while (count.untold > 0) {
    store_.emit(ProgramNotice{kind, std::exchange(count.untold, 0)});
    auto pause = tasks_.pause(kProgramNoticePause);
    co_await pause;
  }
  count.telling = false;
}

std::optional<Problem> Session::may_write(const ExchangeRequest& request, TimePoint) {
  const auto live = motions_.find_live(request.motion);
  if (live && store_.state().emergency) {
    if (auto forbidden = rights_.motion_forbidden(live->motion.axes)) return forbidden;
  }
  // Motions abandoned at the gateway's end send nothing more.
  if (!live && ending_) return ending_;
  const bool alone = request.motion == 0 && !request.uses.empty();
  if ((!live && !alone) || !guarded(Guard::lease_asked_as_bytes_go)) return {};
  Use use{request.caller, request.lease, request.uses, 0};
  if (live) use = {live->context.who, live->context.lease, live->uses, live->motion.id};
  const auto allowed = rights_.still_authorized(use);
  if (allowed) return {};
  return allowed.error();
}

}  // namespace axisgate::shrc203
