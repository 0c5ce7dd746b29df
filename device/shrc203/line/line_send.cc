// Output of Line: the order of the waiting lines, the conditions for sending them, and writing.
#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/line/line.h"

namespace axisgate::shrc203 {
namespace {

bool is_line_before(const ExchangeRequest& request) { return request.command.row->meaning == Meaning::line_before; }

}  // namespace

// Returns the axes whose completions could not be distinguished from the reply.
AxisSet Line::ambiguous(const ExchangeRequest& request, AxisSet axes) const {
  const CommandRow& row = *request.command.row;
  if (request.closed || !guarded(Guard::number_questions_wait)) return {};
  const bool asked_alone = row.separation == Separation::all_axes && controllable_.count() <= 1;
  const bool asked_whole = row.separation == Separation::waits || row.separation == Separation::closed;
  if (!asked_whole && !asked_alone) return {};
  const auto range = bare_number_range(row);
  AxisSet found;
  for (const int axis : axes.list()) {
    if (range && axis >= range->minimum && axis <= range->maximum) found.add(axis);
  }
  return found;
}

AxisSet Line::conflicts(const ExchangeRequest& request) const { return ambiguous(request, completions_.possible()); }

// Returns the time from which !: may be sent on behalf of a question that waits until all completions have arrived.
std::optional<TimePoint> Line::conflicts_settle_from() const {
  std::optional<TimePoint> earliest;
  queue_.for_each([&](const WaitingPtr& waiting) {
    const AxisSet axes = conflicts(waiting->request);
    const auto from = axes.empty() ? std::nullopt : completions_.settles_from(axes);
    if (from && (!earliest || *from < *earliest)) earliest = from;
  });
  return earliest;
}

// Counts a question until it is written, even if it may be sent now: if other lines go first, the next motion would
// hold it back again.
std::optional<HeldQuestion> Line::held_question() const {
  std::optional<HeldQuestion> oldest;
  if (!state_.trusted() || sealed_) return oldest;
  queue_.for_each([&](const WaitingPtr& waiting) {
    const ExchangeRequest& request = waiting->request;
    if (request.handshake || (oldest && oldest->since <= waiting->asked)) return;
    if (ambiguous(request, controllable_).empty()) return;
    oldest = HeldQuestion{request.command.line, request.caller, waiting->asked};
  });
  return oldest;
}

bool Line::may_send(const ExchangeRequest& request) const {
  const bool certain = state_.trusted() && !continuity_.open();
  if (sealed_ && request.lane != Lane::stop) return false;
  if (!certain && !request.handshake && request.lane != Lane::stop) return false;
  return conflicts(request).empty();
}

void Line::pump(TimePoint now) {
  if (!can_send()) return;
  expire(now);
  const bool quiet = after_refused_stop_ && now < *after_refused_stop_ && guarded(Guard::quiet_after_refused_stop);
  const bool coming = line_is_coming(now) || quiet;
  const auto may_go = [&](const WaitingPtr& waiting) {
    const auto& request = waiting->request;
    const bool does_not_wait = request.lane == Lane::stop && !quiet;
    return (!coming || does_not_wait) && may_send(request) && leaves_refills_alone(request, now);
  };
  const auto settles = coming ? std::nullopt : conflicts_settle_from();
  const bool settle = settles && now >= *settles && may_settle(now);
  const bool asks = asks_first(now);
  if (asks && asks_now(may_go, settle)) {
    ExchangeRequest question;
    question.command = commands::ask(kLineBefore);
    send(std::make_shared<Waiting>(Waiting{std::move(question), {}, now}), now);
    return;
  }
  const auto may_go_unasked = [&](const WaitingPtr& waiting) {
    const auto& request = waiting->request;
    return may_go(waiting) && (!asks || request.lane == Lane::stop || is_line_before(request));
  };
  if (auto next = take_next(may_go_unasked, now)) {
    send(std::move(next), now);
    return;
  }
  if (!settle || asks) return;
  ExchangeRequest probe;
  probe.command = commands::ask(kSettling);
  send(std::make_shared<Waiting>(Waiting{std::move(probe), {}, now}), now);
}

// Returns null if nothing may be sent. Requests that lost their right while they waited are refused and never sent.
WaitingPtr Line::take_next(const std::function<bool(const WaitingPtr&)>& may_go, TimePoint now) {
  while (auto next = queue_.take(may_go)) {
    const ExchangeRequest& request = (*next)->request;
    const bool asks = (request.motion != 0 || !request.uses.empty()) && !request.tidies;
    const auto refusal = asks ? listener_.may_write(request, now) : std::nullopt;
    if (!refusal) return *next;
    for (auto& answer : (*next)->answers) {
      answer.deliver({.written = false, .problem = *refusal});
    }
  }
  return nullptr;
}

// Reports whether ?:CMD must be sent before anything else. After a pause it shows whether the controller has restarted
// meanwhile. After NG the line may have cut the command in two, and a late NG to the other part cannot be the reply to
// ?:CMD.
bool Line::asks_first(TimePoint now) const {
  const bool paused =
      state_.trusted() && continuity_.due(now) && !continuity_.open() && guarded(Guard::question_before_pause_ends);
  return paused || (second_reply_possible_ && guarded(Guard::question_after_refusal));
}

// Reports whether ?:CMD is sent now. A stop whose turn it is does not wait for ?:CMD.
bool Line::asks_now(const std::function<bool(const WaitingPtr&)>& may_go, bool settle) const {
  bool any = settle, stop = false;
  queue_.for_each([&](const WaitingPtr& waiting) {
    const bool is_stop = waiting->request.lane == Lane::stop;
    stop = stop || is_stop;
    any = any || (!is_stop && may_go(waiting) && !is_line_before(waiting->request));
  });
  return any && !(stop && queue_.stops_turn());
}

// Reports whether an incomplete line was received. Its rest could be taken for the reply to the next command, so only
// stops are sent meanwhile.
bool Line::line_is_coming(TimePoint now) {
  if (!framer_.mid_line()) {
    partial_since_.reset();
    return false;
  }
  if (!partial_since_) partial_since_ = now;
  return !drop_unended(now) && guarded(Guard::half_lines_hold);
}

bool Line::drop_unended(TimePoint now) {
  if (!partial_since_ || now < *partial_since_ + kPartialLineLimit || !guarded(Guard::unended_lines)) return false;
  framer_.clear();
  partial_since_.reset();
  unexpected("(a line that did not end)", now);
  return true;
}

void Line::send(WaitingPtr waiting, TimePoint now) {
  const auto& request = waiting->request;
  const auto limit =
      request.command.row->reply_limit > Duration::zero() ? request.command.row->reply_limit : profile_.reply_limit;
  const Duration on_the_wire = timing_.time_of(request.command.line.size() + 2 + LineTiming::kReplyBytesMax);
  // Only a stop is sent after half a line, which must not become the start of the stop's reply.
  if (framer_.mid_line() && guarded(Guard::half_lines_before_stops)) framer_.clear();
  if (!request.completes.empty()) completions_.started(request.completes, now);
  // A stop is written right after ?:CMD, without waiting for the reply to it.
  const bool echo_first = request.lane == Lane::stop && state_.trusted() && continuity_.due(now);
  if (echo_first) write_line(commands::text(kLineBefore));
  write_line(request.command.line, ++exchanges_, &request);
  in_flight_ = InFlight{std::move(waiting), now, now + limit + on_the_wire, exchanges_, {}, echo_first};
}

// Writes stops at once in a barrier. Their replies cannot be distinguished from late replies.
void Line::send_stops_now(TimePoint now) {
  if (!state_.port_open() || !barrier_ || !guarded(Guard::stop_in_barrier) || !write_waiting_stops()) return;
  if (guarded(Guard::barrier_after_stop)) barrier_->restart(now);
}

bool Line::write_open_stops(std::string_view heard) {
  const auto stops = listener_.stops_to_write(heard, now_);
  for (const ExchangeRequest& stop : stops) write_line(stop.command.line, ++exchanges_, &stop);
  return !stops.empty();
}

bool Line::write_waiting_stops() {
  bool any = false;
  queue_.drain([](const WaitingPtr& waiting) { return waiting->request.lane == Lane::stop; },
               [&](const WaitingPtr& waiting) {
                 any = true;
                 write_line(waiting->request.command.line, ++exchanges_, &waiting->request);
                 const Problem problem{.reason = Reason::outcome_unknown,
                                       .message =
                                           "the stop was written while the line was being resynchronised; its answer "
                                           "cannot be believed",
                                       .hint = "check the positions",
                                       .sent = waiting->request.command.line};
                 for (auto& answer : waiting->answers) answer.deliver({.written = true, .problem = problem});
               });
  return any;
}

void Line::write_line(std::string_view line, std::uint64_t exchange, const ExchangeRequest* cause) {
  std::string bytes(line);
  bytes += "\r\n";
  // Saving to memory may take long, which is no sign of a restart.
  const Duration saving = cause ? cause->command.row->reply_limit : Duration::zero();
  continuity_.wrote(line, timing_.time_of(bytes.size() + LineTiming::kReplyBytesMax) + saving, now_);
  BytesWritten written;
  written.bytes = bytes;
  written.exchange = exchange;
  if (cause) {
    written.who = cause->caller;
    written.lane = cause->lane;
    written.completes = cause->completes;
    written.motion = cause->motion;
    written.closed = cause->closed;
    written.question = cause->command.row->effect == Effect::question;
    if (!written.question) written.axes = cause->command.axes(controllable_);
  }
  // Reported before the bytes are written: a listener that records what was written must not be killed in between.
  listener_.line_event(written, now_);
  link_.write(bytes);
}

}  // namespace axisgate::shrc203
