#include "device/shot/line/recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shot/limits.h"

namespace axisgate::shot {
namespace {

Guard guard_of(ExchangeEnded::Outcome doubt) {
  if (doubt == ExchangeEnded::Outcome::timed_out) return Guard::barrier_after_time_limit;
  return doubt == ExchangeEnded::Outcome::ng_i ? Guard::barrier_after_line_fault : Guard::barrier_after_garbage;
}

}  // namespace

void Recovery::connect(TimePoint now) {
  outstanding_ = {};
  // After a connect every reply to ?:CMD is accepted: nothing was sent on this connection.
  begin(std::string(asks_line_before_ ? Barrier::kAnyLine : ""), connect_limits(), std::nullopt);
  write_open_stops({}, now);
  if (Barrier* const barrier = exchange_.barrier()) barrier->start(now);
}

void Recovery::doubt(ExchangeResult doubted, ExchangeEnded::Outcome outcome, TimePoint now) {
  if (!guarded(guard_of(outcome))) return results_.finish(doubted, outcome, now);
  const InFlight abandoned = *exchange_.in_flight();
  const Command& command = abandoned.request().command;
  if (command.row->may_chain()) completions_.chained(command.axes(controllable_), now);
  const std::string why = doubted.problem->message;
  const std::string last_line(exchange_.closing() ? text(kClosing) : command.line);
  results_.report(abandoned, doubted, outcome, now);
  begin(last_line, limits(), Doubted{abandoned.waiting, std::move(doubted)});
  port_.change(LinkEvent::answer_doubted, now);
  listener_.barrier_entered(why, now);
  if (Barrier* const barrier = exchange_.barrier()) barrier->start(now);
  send_stops(now);
}

void Recovery::begin(std::string line_in_doubt, Barrier::Limits limits, std::optional<Doubted> doubted) {
  exchange_.doubted(std::make_unique<Barrier>(
                        model_, std::move(line_in_doubt), limits, outstanding_,
                        [this](const Identity& identity) { return is_known(identity); },
                        [this](std::string_view line, TimePoint now) { wire_.probe(line, now); }),
                    std::move(doubted));
}

void Recovery::on_line(std::string_view text, TimePoint now) {
  Barrier* barrier = exchange_.barrier();
  const bool stopped = write_open_stops(text, now) && guarded(Guard::barrier_after_stop);
  const bool first_step = barrier->in_first_step();
  const bool echoed = barrier->echo().has_value(), identified = barrier->identity().has_value();
  if (!barrier->on_line(text, now)) listener_.line_event(UnexpectedLine{std::string(text)}, now);
  if (!echoed && barrier->echo() && !link_.identifying()) on_last_command(std::string(*barrier->echo()), now);
  barrier = exchange_.barrier();
  if (barrier == nullptr) return;  // disconnected
  if (!identified && barrier->identity()) continuity_.answered(true, now);
  moved(now);
  barrier = exchange_.barrier();
  // A reply to an *IDN? that is only sent now comes after the stop's, so no restart is needed.
  if (stopped && barrier != nullptr && !(first_step && !barrier->in_first_step())) barrier->restart(now);
}

void Recovery::advance(TimePoint now) {
  const int before = outstanding_count();
  exchange_.barrier()->advance(now);
  if (outstanding_count() > before) listener_.line_event(TimeLimitPassed{TimeLimitPassed::Kind::probe}, now);
  moved(now);
}

void Recovery::moved(TimePoint now) {
  const Barrier& barrier = *exchange_.barrier();
  if (barrier.state() == Barrier::State::probing) return;
  if (barrier.state() == Barrier::State::failed) return port_.close(LinkEvent::lost, barrier.why_failed(), now);
  const Identity identity = *barrier.identity();
  const std::optional<bool> received = barrier.received();
  const std::optional<std::string> line_before = barrier.echo();
  // The controller replies in order, so every line before the *IDN? has been answered or is lost.
  outstanding_.echoes = 0;
  second_reply_.possible = false;
  std::optional<Doubted> doubted = exchange_.resolved();
  listener_.line_event(LineLearned{LineLearned::What::barrier_passed, {}}, now);
  const bool connecting = link_.identifying();
  if (connecting) answering_ = identity.serial_number;
  if (doubted) {
    if (received) {
      doubted->result.problem->message +=
          *received ? "; the controller had received it" : "; the controller had not received it";
      doubted->result.received = *received;
    }
    doubted->waiting->deliver(doubted->result);
  }
  port_.change(connecting ? LinkEvent::identified : LinkEvent::barrier_passed, now);
  if (connecting) {
    asks_line_before_ = false;
    listener_.line_connected(identity, line_before, now);
  } else {
    listener_.barrier_passed(identity, now);
  }
}

void Recovery::on_last_command(std::string_view line_before, TimePoint now) {
  const auto verdict = continuity_.compare(line_before, now);
  // A part of the ?:CMD may have been received as another question.
  second_reply_.possible = verdict != Continuity::Verdict::same;
  if (verdict == Continuity::Verdict::foreign && guarded(Guard::foreign_traffic)) {
    port_.close(LinkEvent::lost,
                fmt::format("the controller was last sent \"{}\", and not from here: another program uses the line, or "
                            "the line is disturbed",
                            escaped(line_before)),
                now);
  }
}

void Recovery::send_stops(TimePoint now) {
  if (exchange_.barrier() == nullptr || !guarded(Guard::stop_in_barrier)) return;
  bool any = false;
  waiting_.take_stops([&](const WaitingPtr& waiting) {
    any = true;
    wire_.begin(waiting->request, now);
    waiting->deliver({.written = true,
                      .problem = Problem{.reason = Reason::outcome_unknown,
                                         .message = "the stop was written while the line was being resynchronised; its "
                                                    "answer cannot be believed",
                                         .hint = "check the positions",
                                         .sent = waiting->request.command.line}});
  });
  if (any && guarded(Guard::barrier_after_stop)) exchange_.barrier()->restart(now);
}

// Returns whether a stop was written.
bool Recovery::write_open_stops(std::string_view heard, TimePoint now) {
  const auto stops = listener_.stops_to_write(heard, now);
  for (const ExchangeRequest& stop : stops) wire_.begin(stop, now);
  return !stops.empty();
}

Barrier::Limits Recovery::limits() const {
  const Duration longest_reply = timing_.time_of(timing_.reply_bytes_max());
  return {profile_.reply_limit + longest_reply, std::max(kBarrierSilenceMin, 3 * longest_reply)};
}

// Extends the silence after a reconnect: a slow controller may still reply to lines of the previous connection.
Barrier::Limits Recovery::connect_limits() {
  Barrier::Limits silent = limits();
  const bool before = std::exchange(connected_before_, true);
  if (before && guarded(Guard::silence_after_reconnect)) silent.silence = std::max(silent.silence, silent.reply);
  return silent;
}

// Reports whether the identity is that of the configured controller, or of the controller that was connected before.
bool Recovery::is_known(const Identity& identity) const {
  const std::string& serial_number = profile_.serial_number.empty() ? trusted_ : profile_.serial_number;
  return identity.model == model_.name() && (serial_number.empty() || identity.serial_number == serial_number);
}

}  // namespace axisgate::shot
