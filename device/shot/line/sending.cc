#include "device/shot/line/sending.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/shot/limits.h"

namespace axisgate::shot {
namespace {

constexpr auto kLineBefore = LineQuestion::line_before, kSettling = LineQuestion::ready;

bool asks_line_before(const ExchangeRequest& request) { return request.command.row->meaning == Meaning::line_before; }

}  // namespace

void Sending::pump(TimePoint now) {
  if (!can_send()) return;
  waiting_.expire(now);
  const auto& silence = second_reply_.silence_until;
  const bool quiet = silence && now < *silence && guarded(Guard::quiet_after_refused_stop);
  const bool coming = line_is_coming(now) || quiet;
  const auto may_go = [&](const Waiting& waiting) {
    const auto& request = waiting.request;
    const bool does_not_wait = request.lane == Lane::stop && !quiet;
    return (!coming || does_not_wait) && may_send(request) && leaves_refills_alone(request, now);
  };
  const auto settles = coming ? std::nullopt : waiting_.conflicts_settle_from();
  const bool settle = settles && now >= *settles && may_settle(now);
  const bool asks = asks_first(now);
  if (asks && asks_now(may_go, settle)) return ask(kLineBefore, now);
  const auto may_go_unasked = [&](const Waiting& waiting) {
    const auto& request = waiting.request;
    return may_go(waiting) && (!asks || request.lane == Lane::stop || asks_line_before(request));
  };
  if (auto next = waiting_.take(may_go_unasked, now)) return send(std::move(next), now);
  if (settle && !asks) ask(kSettling, now);
}

std::optional<TimePoint> Sending::next_deadline(TimePoint now) const {
  if (!can_send()) return std::nullopt;
  std::optional<TimePoint> next;
  const auto sooner = [&next](TimePoint at) {
    if (!next || at < *next) next = at;
  };
  TimePoint held = second_reply_.silence_until.value_or(now);
  const auto unended = incoming_.unended_from();
  if (unended) held = std::max(held, *unended);
  if (held > now || unended) sooner(held);
  const auto expiry = reservations_.next_expiry(now);
  if (expiry) sooner(*expiry);
  if (const auto settles = waiting_.conflicts_settle_from()) {
    const TimePoint at = std::max(*settles, held);
    sooner(at <= now && expiry ? *expiry : at);
  }
  return next;
}

void Sending::ask(LineQuestion question, TimePoint now) {
  ExchangeRequest request;
  request.command = model_.ask(question);
  send(std::make_shared<Waiting>(Waiting{std::move(request), {}, now}), now);
}

bool Sending::may_send(const ExchangeRequest& request) const {
  const bool certain = link_.trusted() && !continuity_.open();
  if (waiting_.sealed() && request.lane != Lane::stop) return false;
  if (!certain && !request.handshake && request.lane != Lane::stop) return false;
  return waiting_.conflicts(request).empty();
}

// Reports whether the request delays no refill. Lines of the handshake always may be sent: without their replies no
// refill could be sent either.
bool Sending::leaves_refills_alone(const ExchangeRequest& request, TimePoint now) const {
  if (profile_.refills != Refills::reserved || request.handshake || request.lane <= Lane::path_refill) return true;
  if (waiting_.size(Lane::path_refill) > 0) return false;
  if (reservations_.empty()) return true;
  Duration length = timing_.longest_exchange(request.command);
  if (continuity_.due(now)) length += timing_.longest_exchange(model_.ask(kLineBefore));
  return reservations_.allow(request.motion, length, now);
}

bool Sending::may_settle(TimePoint now) const {
  return reservations_.empty() || reservations_.allow(0, timing_.longest_exchange(model_.ask(kSettling)), now);
}

// Reports whether ?:CMD must be sent before anything else. After a pause it shows whether the controller has restarted
// meanwhile. After NG the line may have cut the command in two, and a late NG to the other part cannot be the reply to
// ?:CMD.
bool Sending::asks_first(TimePoint now) const {
  const bool paused =
      link_.trusted() && continuity_.due(now) && !continuity_.open() && guarded(Guard::question_before_pause_ends);
  return paused || (second_reply_.possible && guarded(Guard::question_after_refusal));
}

// Reports whether ?:CMD is sent now. A stop whose turn it is does not wait for ?:CMD.
bool Sending::asks_now(const WaitingLines::Chosen& may_go, bool settle) const {
  bool any = settle, stop = false;
  waiting_.for_each([&](const Waiting& waiting) {
    const bool is_stop = waiting.request.lane == Lane::stop;
    stop = stop || is_stop;
    any = any || (!is_stop && may_go(waiting) && !asks_line_before(waiting.request));
  });
  return any && !(stop && waiting_.stops_turn());
}

// Reports whether an incomplete line was received. Its rest could be taken for the reply to the next command, so only
// stops are sent meanwhile.
bool Sending::line_is_coming(TimePoint now) {
  incoming_.note_half_line(now);
  if (!incoming_.mid_line()) return false;
  if (!incoming_.drop_unended(now)) return guarded(Guard::half_lines_hold);
  listener_.line_event(UnexpectedLine{std::string(kUnended)}, now);
  return false;
}

void Sending::send(WaitingPtr waiting, TimePoint now) {
  const ExchangeRequest& request = waiting->request;
  const Duration own_limit = request.command.row->reply_limit;
  const Duration limit = own_limit > Duration::zero() ? own_limit : profile_.reply_limit;
  const Duration on_the_wire = timing_.time_of(request.command.line.size() + 2 + timing_.reply_bytes_max());
  // Only a stop is sent after half a line, which must not become the start of the stop's reply.
  if (incoming_.mid_line() && guarded(Guard::half_lines_before_stops)) incoming_.clear();
  if (!request.completes.empty()) completions_.started(request.completes, now);
  // A stop is written right after ?:CMD, without waiting for the reply to it.
  const bool after_question = request.lane == Lane::stop && link_.trusted() && continuity_.due(now);
  if (after_question) wire_.probe(text(kLineBefore), now);
  const std::uint64_t number = wire_.begin(request, now);
  exchange_.written({std::move(waiting), now, now + limit + on_the_wire, number}, after_question);
}

}  // namespace axisgate::shot
