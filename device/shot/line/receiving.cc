#include "device/shot/line/receiving.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shot/limits.h"

namespace axisgate::shot {
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

}  // namespace

void Receiving::receive(std::string_view bytes, TimePoint now) {
  listener_.line_event(BytesReceived{std::string(bytes)}, now);
  flood_.received(bytes.size(), now);
  incoming_.push(bytes);
  while (auto line = incoming_.next()) on_line(*line, now);
  if (shut_if_flooded(now)) return;
  incoming_.note_half_line(now);
  if (Barrier* const barrier = exchange_.barrier(); barrier != nullptr && incoming_.mid_line()) {
    barrier->on_half_line(now);
  }
  suspect_restart(now);
}

void Receiving::check_time_limit(TimePoint now) {
  const InFlight* const late = exchange_.in_flight();
  if (late == nullptr || now < late->limit) return;
  listener_.line_event(TimeLimitPassed{TimeLimitPassed::Kind::reply}, now);
  // Otherwise the first reply in the barrier would complete that line.
  if (incoming_.drop_unended(now)) unexpected(kUnended, now);
  const std::string& sent = late->request().command.line;
  recovery_.doubt({.written = true,
                   .problem = Problem{.reason = Reason::reply_timed_out,
                                      .message = fmt::format("\"{}\" was not answered in time", sent),
                                      .sent = sent}},
                  ExchangeEnded::Outcome::timed_out, now);
}

// Closes the port of a device that sends without end, until the next reopening. Reading on would occupy a core and fill
// the recording.
bool Receiving::shut_if_flooded(TimePoint now) {
  if (!link_.port_open() || !flood_.too_much() || !guarded(Guard::flooded_line_shut)) return false;
  port_.close(LinkEvent::flooded,
              "it sends without end: unexpected bytes fill more than half of the line's capacity; check what is "
              "connected, and the baud rate at both ends",
              now);
  return true;
}

void Receiving::on_line(const LineFramer::Line& line, TimePoint now) {
  const bool overlong = line.overlong && guarded(Guard::overlong_lines);
  if (const auto reported = model_.notice(line.text); reported && guarded(Guard::notices_distinguished)) {
    return listener_.line_event(ProgramNotice{*reported}, now);
  }
  if (!overlong && on_axis_number(line.text, now)) return;
  switch (exchange_.phase()) {
    case ExchangePhase::in_doubt:
      return recovery_.on_line(line.text, now);
    case ExchangePhase::idle:
      if (!settle_outstanding(model_, recovery_.outstanding(), line.text)) unexpected(line.text, now);
      return;
    case ExchangePhase::closing:
      return on_line_while_closing(line.text, now);
    case ExchangePhase::after_question:
    case ExchangePhase::in_flight:
      break;
  }
  on_answer(line, now);
}

void Receiving::on_answer(const LineFramer::Line& line, TimePoint now) {
  const bool overlong = line.overlong && guarded(Guard::overlong_lines);
  if (refusal_is_unclear(line.text)) return doubt_answer(line.text, now);
  const CommandRow& row = *exchange_.in_flight()->request().command.row;
  const bool after_question = exchange_.phase() == ExchangePhase::after_question;
  const bool line_before = after_question || row.meaning == Meaning::line_before;
  const bool possible = !overlong && (continuity_.could_be(line.text) || !guarded(Guard::possible_lines_before));
  if (line_before && !possible) return doubt_answer(line.text, now);
  if (after_question) {
    exchange_.question_answered();
    return recovery_.on_last_command(line.text, now);
  }
  if (auto reply = overlong ? std::nullopt : parse_reply(model_, row, line.text, controllable_.count())) {
    return on_reply(std::move(*reply), now);
  }
  if (!settle_outstanding(model_, recovery_.outstanding(), line.text)) doubt_answer(line.text, now);
}

// Reports whether `text` is a refusal that may answer another line than the one in flight.
bool Receiving::refusal_is_unclear(std::string_view text) {
  if (text != "NG" && text != "NG_I") return false;
  if (recovery_.outstanding().identities > 0 && guarded(Guard::outstanding_refusals)) {
    // A late *IDN? may have arrived damaged, so this refusal may answer it or the command in flight.
    --recovery_.outstanding().identities;
    return true;
  }
  // Stops are written even while a second reply to the previous line may follow. Only after a refused stop they wait
  // for kPauseAfterRefusedStop.
  const bool is_stop = exchange_.in_flight()->request().lane == Lane::stop;
  return is_stop && second_reply_.possible && !second_reply_.silence_until && guarded(Guard::refusals_before_stops);
}

// Suspects a restart if the controller has answered nothing for too long.
void Receiving::suspect_restart(TimePoint now) {
  const bool asks = link_.trusted() && !link_.restart_suspected();
  if (!asks || !continuity_.open() || !guarded(Guard::restart_suspected)) return;
  port_.change(LinkEvent::restart_suspected, now);
  listener_.restart_suspected(now);
}

void Receiving::doubt_answer(std::string_view text, TimePoint now) {
  const std::string& sent = exchange_.in_flight()->request().command.line;
  recovery_.doubt(
      {.written = true,
       .problem = Problem{.reason = Reason::line_fault,
                          .message = fmt::format("\"{}\" was answered by \"{}\", which cannot be its answer", sent,
                                                 escaped(text)),
                          .sent = sent,
                          .wire_reply = std::string(text)}},
      ExchangeEnded::Outcome::garbled, now);
}

// Handles `text` if it is an axis number that is or may be a completion. Returns false otherwise.
bool Receiving::on_axis_number(std::string_view text, TimePoint now) {
  if (text.size() != 1 || text[0] < '1' || text[0] > '9') return false;
  const int axis = text[0] - '0';
  if (!model_.axes().has(axis)) return false;
  const bool possible = completions_.possible(axis);
  if (possible) flood_.belonged(text.size() + LineTiming::kTerminator);
  if (const InFlight* const line = exchange_.in_flight()) {
    const bool closed = line->request().closed && guarded(Guard::closed_questions);
    if (closed && (possible || exchange_.closing())) {
      on_number(axis, now);
      return true;
    }
    // No question whose reply a possible completion could look like is in flight now (WaitingLines::conflicts()).
    const CommandRow& row = *line->request().command.row;
    if (row.separation != Separation::grammar && parse_reply(model_, row, text, controllable_.count())) return false;
  }
  listener_.completion_seen(axis, !possible || exchange_.phase() == ExchangePhase::in_doubt, now);
  return true;
}

// Collects a number that may be the reply or a completion. The controller replies in order, so when the !:S after the
// number is answered, the reply is among the numbers received.
void Receiving::on_number(int number, TimePoint now) {
  continuity_.answered(false, now);
  if (!exchange_.closing()) {
    InFlight& line = *exchange_.in_flight();
    wire_.go_on(text(kClosing), line.exchange, line.request(), now);
    line.limit = now + recovery_.reply_limit();
  }
  exchange_.number_received(number);
}

void Receiving::on_line_while_closing(std::string_view text, TimePoint now) {
  const auto number = text.size() <= 2 ? parse_integer(text) : std::nullopt;
  if (number && *number >= 0) return on_number(static_cast<int>(*number), now);
  const auto ready = parse_reply(model_, *model_.ask(kClosing).row, text, controllable_.count());
  if (ready && ready->kind == Reply::Kind::data) return close(now);
  doubt_answer(text, now);
}

void Receiving::close(TimePoint now) {
  continuity_.answered(true, now);
  std::vector<int> numbers = exchange_.in_flight()->numbers;
  const auto may_be_axis = [this](int number) {
    return number >= 1 && number <= model_.axis_count() && completions_.possible(number);
  };
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
  results_.finish(result, ExchangeEnded::Outcome::data, now);
  for (const int axis : completed) listener_.completion_seen(axis, true, now);
}

void Receiving::on_reply(Reply reply, TimePoint now) {
  const ExchangeRequest& request = exchange_.in_flight()->request();
  const bool line_before = request.command.row->meaning == Meaning::line_before;
  const std::string reported = line_before ? reply.text : "";
  if (!line_before) continuity_.answered(reply.kind != Reply::Kind::ng && reply.kind != Reply::Kind::ng_i, now);
  if (reply.kind == Reply::Kind::ng_i) return on_line_fault(std::move(reply), now);
  if (reply.kind == Reply::Kind::ng) {
    const bool was_stop = request.lane == Lane::stop;
    second_reply_ = {true, was_stop ? std::optional(now + kPauseAfterRefusedStop) : std::nullopt};
  }
  if (reply.kind == Reply::Kind::ok_d) completions_.chained(request.command.axes(controllable_), now);
  const auto outcome = outcome_of(reply.kind);
  results_.finish({.written = true, .reply = std::move(reply)}, outcome, now);
  if (line_before) recovery_.on_last_command(reported, now);
}

void Receiving::on_line_fault(Reply reply, TimePoint now) {
  const std::string& sent = exchange_.in_flight()->request().command.line;
  Problem fault{.reason = Reason::line_fault,
                .message = fmt::format("the controller received a character that \"{}\" does not contain (NG_I): the "
                                       "line is disturbed",
                                       sent),
                .hint = "check the cable and the line settings",
                .sent = sent,
                .wire_reply = reply.text};
  recovery_.doubt({.written = true, .reply = std::move(reply), .problem = std::move(fault)},
                  ExchangeEnded::Outcome::ng_i, now);
}

void Receiving::unexpected(std::string_view text, TimePoint now) {
  listener_.line_event(UnexpectedLine{std::string(text)}, now);
}

}  // namespace axisgate::shot
