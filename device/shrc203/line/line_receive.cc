// Input of Line: replies, completions, garbage, and the recovery from doubt.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/line/exchange.h"
#include "device/shrc203/line/line.h"

namespace axisgate::shrc203 {
namespace {

ExchangeEnded::Outcome outcome_of(Reply::Kind kind) {
  switch (kind) {
    case Reply::Kind::ok:
      return ExchangeEnded::Outcome::ok;
    case Reply::Kind::ok_d:
      return ExchangeEnded::Outcome::ok_d;
    case Reply::Kind::ng:
      return ExchangeEnded::Outcome::ng;
    case Reply::Kind::ng_i:
      return ExchangeEnded::Outcome::ng_i;
    case Reply::Kind::data:
      break;
  }
  return ExchangeEnded::Outcome::data;
}

// Returns the program notice in `text`; nullopt if there is none. A notice is never a reply (manual 109), 110)).
std::optional<ProgramNotice::Kind> program_notice(std::string_view text) {
  if (text == "COMP") return ProgramNotice::Kind::ended;
  if (text == "TRIG") return ProgramNotice::Kind::trigger;
  return {};
}

Guard guard_of(ExchangeEnded::Outcome doubt) {
  if (doubt == ExchangeEnded::Outcome::timed_out) return Guard::barrier_after_time_limit;
  return doubt == ExchangeEnded::Outcome::ng_i ? Guard::barrier_after_line_fault : Guard::barrier_after_garbage;
}

}  // namespace

void Line::receive(std::string_view bytes, TimePoint now) {
  now_ = now;
  listener_.line_event(BytesReceived{std::string(bytes)}, now);
  if (!framer_.mid_line()) partial_since_.reset();
  flood_.received(bytes.size(), now);
  framer_.push(bytes);
  while (auto line = framer_.next()) {
    partial_since_.reset();
    on_line(*line, now);
  }
  if (shut_if_flooded(now)) return;
  if (framer_.mid_line() && !partial_since_) partial_since_ = now;
  if (framer_.mid_line() && barrier_) barrier_->on_half_line(now);
  look_at_continuity(now);
  pump(now);
}

// Shuts the line of a device that sends without end, until the next reopening. Reading on would occupy a core and fill
// the recording.
bool Line::shut_if_flooded(TimePoint now) {
  if (!state_.port_open() || !flood_.too_much() || !guarded(Guard::flooded_line_shut)) return false;
  change(LinkEvent::flooded, now);
  shut(
      "it sends without end: unexpected bytes fill more than half of the line's capacity; check what is connected, and "
      "the baud rate at both ends",
      now);
  return true;
}

void Line::on_line(const LineFramer::Line& line, TimePoint now) {
  const bool overlong = line.overlong && guarded(Guard::overlong_lines);
  if (const auto reported = program_notice(line.text); reported && guarded(Guard::notices_distinguished)) {
    return listener_.line_event(ProgramNotice{*reported}, now);
  }
  if (!overlong && on_axis_number(line.text, now)) return;
  if (barrier_) {
    const bool stopped = write_open_stops(line.text) && guarded(Guard::barrier_after_stop);
    const bool first_step = barrier_->in_first_step();
    in_barrier(line.text, now);
    // A reply to an *IDN? that is only sent now comes after the stop's, so no restart is needed.
    const bool behind = first_step && barrier_ && !barrier_->in_first_step();
    if (stopped && barrier_ && !behind) barrier_->restart(now);
    return;
  }
  if (!in_flight_) {
    if (!settle_outstanding(outstanding_, line.text)) unexpected(line.text, now);
    return;
  }
  if (!in_flight_->numbers.empty()) return on_line_while_closing(line.text, now);
  const auto& row = *in_flight_->waiting->request.command.row;
  const bool refusal = line.text == "NG" || line.text == "NG_I";
  if (outstanding_.identities > 0 && refusal && guarded(Guard::outstanding_refusals)) {
    // A late *IDN? may have arrived damaged, so this refusal may answer it or the command in flight.
    --outstanding_.identities;
    doubt_answer(line.text, now);
    return;
  }
  // Stops are written even while a second reply to the previous line may follow. Only after a refused stop they wait
  // for kPauseAfterRefusedStop.
  const bool is_stop = in_flight_->waiting->request.lane == Lane::stop;
  const bool maybe_older = is_stop && second_reply_possible_ && !after_refused_stop_;
  if (refusal && maybe_older && guarded(Guard::refusals_before_stops)) return doubt_answer(line.text, now);
  const bool line_before = in_flight_->echo_first || row.meaning == Meaning::line_before;
  const bool possible = !overlong && (continuity_.could_be(line.text) || !guarded(Guard::possible_lines_before));
  if (line_before && !possible) return doubt_answer(line.text, now);
  if (std::exchange(in_flight_->echo_first, false)) return on_last_command(line.text, now);
  auto reply = overlong ? std::nullopt : parse_reply(row, line.text, controllable_.count());
  if (reply) {
    on_reply(std::move(*reply), now);
    return;
  }
  if (settle_outstanding(outstanding_, line.text)) return;
  doubt_answer(line.text, now);
}

void Line::in_barrier(std::string_view text, TimePoint now) {
  const bool echoed = barrier_->echo().has_value(), identified = barrier_->identity().has_value();
  if (!barrier_->on_line(text, now)) unexpected(text, now);
  const bool connecting = state_.identifying();
  if (!echoed && barrier_->echo() && !connecting) on_last_command(*barrier_->echo(), now);
  if (!barrier_) return;  // disconnected
  if (!identified && barrier_->identity()) continuity_.answered(true, now);
  barrier_moved(now);
}

// Compares the reply to ?:CMD with the lines sent, and disconnects if another program has written. That program may
// have changed any setting or the frame, so the state is unknown as after a restart.
void Line::on_last_command(std::string_view line_before, TimePoint now) {
  const auto verdict = continuity_.compare(line_before, now);
  // A part of the ?:CMD may have been received as another question.
  second_reply_possible_ = verdict != Continuity::Verdict::same;
  if (verdict == Continuity::Verdict::foreign && guarded(Guard::foreign_traffic)) {
    disconnect(
        fmt::format("the controller was last sent \"{}\", and not from here: another program uses the line, or the "
                    "line is disturbed",
                    escaped(line_before)),
        now);
  }
}

void Line::look_at_continuity(TimePoint now) {
  const bool asks = state_.trusted() && !state_.restart_suspected();
  if (!asks || !continuity_.open() || !guarded(Guard::restart_suspected)) return;
  change(LinkEvent::restart_suspected, now);
  listener_.restart_suspected(now);
}

void Line::doubt_answer(std::string_view text, TimePoint now) {
  const auto& sent = in_flight_->waiting->request.command.line;
  Problem garbage{
      .reason = Reason::line_fault,
      .message = fmt::format("\"{}\" was answered by \"{}\", which cannot be its answer", sent, escaped(text)),
      .sent = sent,
      .wire_reply = std::string(text)};
  const std::string why = garbage.message;
  enter_barrier({.written = true, .problem = std::move(garbage)}, ExchangeEnded::Outcome::garbled, why, now);
}

// Handles `text` if it is an axis number that is or may be a completion. Returns false otherwise.
bool Line::on_axis_number(std::string_view text, TimePoint now) {
  if (text.size() != 1 || text[0] < '1' || text[0] > '3') return false;
  const int axis = text[0] - '0';
  const bool possible = completions_.possible(axis);
  if (possible) flood_.belonged(text.size() + LineTiming::kTerminator);
  const bool closed = in_flight_ && in_flight_->waiting->request.closed && guarded(Guard::closed_questions);
  if (closed && (possible || !in_flight_->numbers.empty())) {
    on_number(axis, now);
    return true;
  }
  // No question whose reply a possible completion could look like is in flight now (conflicts()).
  if (in_flight_) {
    const auto& row = *in_flight_->waiting->request.command.row;
    if (row.separation != Separation::grammar && parse_reply(row, text, controllable_.count())) return false;
  }
  listener_.completion_seen(axis, !possible || barrier_ != nullptr, now);
  return true;
}

// Collects a number that may be the reply or a completion. The controller replies in order, so when the !:S after the
// number is answered, the reply is among the numbers received.
void Line::on_number(int number, TimePoint now) {
  continuity_.answered(false, now);
  if (in_flight_->numbers.empty()) {
    write_line(commands::text(kClosing), in_flight_->exchange, &in_flight_->waiting->request);
    in_flight_->limit = now + barrier_limits().reply;
  }
  in_flight_->numbers.push_back(number);
}

void Line::on_line_while_closing(std::string_view text, TimePoint now) {
  const auto number = text.size() <= 2 ? parse_integer(text) : std::nullopt;
  if (number && *number >= 0) return on_number(static_cast<int>(*number), now);
  const auto ready = parse_reply(commands::row_of(kClosing), text, controllable_.count());
  if (ready && ready->kind == Reply::Kind::data) return close(now);
  doubt_answer(text, now);
}

void Line::close(TimePoint now) {
  continuity_.answered(true, now);
  auto numbers = in_flight_->numbers;
  const auto may_be_axis = [this](int number) { return number >= 1 && number <= 3 && completions_.possible(number); };
  const auto certain = std::ranges::find_if_not(numbers, may_be_axis);
  ExchangeResult result{.written = true};
  if (certain == numbers.end()) {
    result.reply = Reply{Reply::Kind::data, std::to_string(numbers.front()), {std::to_string(numbers.front())}};
    result.candidates = numbers;
  } else {
    result.reply = Reply{Reply::Kind::data, std::to_string(*certain), {std::to_string(*certain)}};
    numbers.erase(certain);
  }
  std::vector<int> completed;
  if (result.candidates.empty()) std::ranges::copy_if(numbers, std::back_inserter(completed), may_be_axis);
  finish(std::move(result), ExchangeEnded::Outcome::data, now);
  for (const int axis : completed) listener_.completion_seen(axis, true, now);
}

void Line::on_reply(Reply reply, TimePoint now) {
  const auto& request = in_flight_->waiting->request;
  const bool line_before = request.command.row->meaning == Meaning::line_before;
  const std::string reported = line_before ? reply.text : "";
  if (!line_before) continuity_.answered(reply.kind != Reply::Kind::ng && reply.kind != Reply::Kind::ng_i, now);
  const auto outcome = outcome_of(reply.kind);
  if (reply.kind == Reply::Kind::ng_i) {
    Problem fault{
        .reason = Reason::line_fault,
        .message = fmt::format("the controller received a character that \"{}\" does not contain (NG_I): the line is "
                               "disturbed",
                               request.command.line),
        .hint = "check the cable and the line settings",
        .sent = request.command.line,
        .wire_reply = reply.text};
    const std::string why = fault.message;
    enter_barrier({.written = true, .reply = std::move(reply), .problem = std::move(fault)}, outcome, why, now);
    return;
  }
  if (reply.kind == Reply::Kind::ng) {
    second_reply_possible_ = true;
    after_refused_stop_.reset();
    if (request.lane == Lane::stop) after_refused_stop_ = now + kPauseAfterRefusedStop;
  }
  if (reply.kind == Reply::Kind::ok_d) completions_.chained(request.command.axes(controllable_), now);
  finish({.written = true, .reply = std::move(reply)}, outcome, now);
  if (line_before) on_last_command(reported, now);
}

ExchangeEnded Line::ended(const InFlight& exchange, const ExchangeResult& result, ExchangeEnded::Outcome outcome,
                          TimePoint now) const {
  const ExchangeRequest& request = exchange.waiting->request;
  return {.command = request.command.row->name,
          .line = request.command.line,
          .reply = result.reply ? result.reply->text : "",
          .lane = request.lane,
          .outcome = outcome,
          .latency = now - exchange.written,
          .closed = !exchange.numbers.empty(),
          .exchange = exchange.exchange,
          .who = request.caller,
          .waited = exchange.written - exchange.waiting->asked};
}

// Returns the axes that a reading shows as busy. The requester processes the reading only after the next line was sent.
AxisSet Line::busy_in(const ExchangeRequest& request, const Reply& reply) const {
  AxisSet busy;
  const bool positions = request.command.line.starts_with("Q:") && reply.kind == Reply::Kind::data;
  const auto readings = positions ? parse_positions(reply, controllable_) : std::nullopt;
  for (std::size_t axis = 0; readings && axis < readings->size(); ++axis) {
    if ((*readings)[axis].valid && (*readings)[axis].busy) busy.add(static_cast<int>(axis) + 1);
  }
  return busy;
}

void Line::finish(ExchangeResult result, ExchangeEnded::Outcome outcome, TimePoint now) {
  const InFlight done = std::move(*in_flight_);
  in_flight_.reset();
  if (result.reply) completions_.answered(done.written, busy_in(done.waiting->request, *result.reply));
  if (result.reply) flood_.belonged(result.reply->text.size() + LineTiming::kTerminator);
  const auto& request = done.waiting->request;
  if (result.reply && done.numbers.empty() && request.lane != Lane::stop) {  // a ?:CMD may have been sent before a stop
    timing_.answered(request.command.line.size(), result.reply->text.size(), now - done.written);
  }
  listener_.line_event(ended(done, result, outcome, now), now);
  for (auto& answer : done.waiting->answers) answer.deliver(result);
}

void Line::enter_barrier(ExchangeResult doubted, ExchangeEnded::Outcome outcome, const std::string& why,
                         TimePoint now) {
  if (!guarded(guard_of(outcome))) return finish(std::move(doubted), outcome, now);
  doubted_waiting_ = in_flight_->waiting;
  const Command& doubted_command = doubted_waiting_->request.command;
  if (doubted_command.row->may_chain()) completions_.chained(doubted_command.axes(controllable_), now);
  std::string last_line(in_flight_->numbers.empty() ? doubted_waiting_->request.command.line
                                                    : commands::text(kClosing));
  doubted_ = std::move(doubted);
  const InFlight abandoned = std::move(*in_flight_);
  in_flight_.reset();
  listener_.line_event(ended(abandoned, *doubted_, outcome, now), now);
  change(LinkEvent::answer_doubted, now);
  listener_.barrier_entered(why, now);
  barrier_ = make_barrier(std::move(last_line), barrier_limits());
  barrier_->start(now);
  send_stops_now(now);
}

void Line::barrier_moved(TimePoint now) {
  if (!barrier_ || barrier_->state() == Barrier::State::probing) return;
  if (barrier_->state() == Barrier::State::failed) {
    disconnect(barrier_->why_failed(), now);
    return;
  }
  const Identity identity = *barrier_->identity();
  const std::optional<bool> barrier_reported = barrier_->received();
  const std::optional<std::string> line_before = barrier_->echo();
  // The controller replies in order, so every line before the *IDN? has been answered or is lost.
  outstanding_.echoes = 0;
  second_reply_possible_ = false;
  barrier_.reset();
  learned(LineLearned::What::barrier_passed);
  const bool connecting = state_.identifying();
  if (connecting) answering_ = identity.serial_number;
  if (doubted_waiting_) {
    if (const auto received = barrier_reported) {
      doubted_->problem->message +=
          *received ? "; the controller had received it" : "; the controller had not received it";
      doubted_->received = *received;
    }
    for (auto& answer : doubted_waiting_->answers) answer.deliver(*doubted_);
    doubted_waiting_.reset();
    doubted_.reset();
  }
  change(connecting ? LinkEvent::identified : LinkEvent::barrier_passed, now);
  if (connecting) {
    asks_line_before_ = false;
    listener_.line_connected(identity, line_before, now);
  } else {
    listener_.barrier_passed(identity, now);
  }
  pump(now);
}

void Line::ready(AxisSet axes, TimePoint now) {
  now_ = now;
  const AxisSet changed = completions_.ready(axes, now);
  if (!changed.empty()) learned(LineLearned::What::ready, changed);
}

void Line::busy(AxisSet axes, TimePoint now) {
  now_ = now;
  const AxisSet changed = completions_.busy(axes);
  if (!changed.empty()) learned(LineLearned::What::busy, changed);
}

void Line::learned(LineLearned::What what, AxisSet axes) { listener_.line_event(LineLearned{what, axes}, now_); }

void Line::unexpected(std::string_view text, TimePoint now) {
  listener_.line_event(UnexpectedLine{std::string(text)}, now);
}

}  // namespace axisgate::shrc203
