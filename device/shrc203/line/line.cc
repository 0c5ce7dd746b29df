#include "device/shrc203/line/line.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

Problem problem_of(Reason reason, std::string message, std::string_view sent) {
  return {.reason = reason, .message = std::move(message), .sent = std::string(sent)};
}

}  // namespace

Line::Line(const Profile& profile, ByteLink& link, Executor& executor, LineListener& listener)
    : profile_(profile),
      link_(link),
      executor_(executor),
      listener_(listener),
      backoff_(kReopenBackoffMin),
      timing_(profile.baud),
      flood_(profile.baud) {}

bool Line::change(LinkEvent event, TimePoint now) {
  const LinkPhase before = state_.phase();
  if (state_.happened(event)) return true;
  listener_.line_event(IllegalTransition{"link", name(before), name(event)}, now);
  disconnect(fmt::format("internal error: {} while the link was {}", name(event), name(before)), now);
  return false;
}

void Line::link_up(TimePoint now) {
  now_ = now;
  if (!change(LinkEvent::port_opened, now)) return;
  listener_.line_opened(now);
  framer_.clear();
  outstanding_ = {};
  second_reply_possible_ = false;
  after_refused_stop_.reset();
  timing_.connected();
  flood_.connected();
  completions_.connected();
  continuity_.connected();
  // After a connect every reply to ?:CMD is accepted: nothing was sent on this connection.
  barrier_ = make_barrier(std::string(asks_line_before_ ? Barrier::kAnyLine : ""), connect_limits());
  write_open_stops({});
  barrier_->start(now);
}

void Line::link_down(TimePoint now, std::string_view why) {
  if (state_.port_open()) {
    disconnect(std::string(why), now);
    return;
  }
  change(LinkEvent::lost, now);
  listener_.line_lost(std::string(why), now);
  link_.reopen(pause_before_reopening());
}

// Returns the pause before the port is opened again; short while a stop is open.
Duration Line::pause_before_reopening() {
  if (!guarded(Guard::backoff)) return Duration::zero();
  if (listener_.stop_is_open() && guarded(Guard::stop_reopens_soon)) return kReopenBackoffMin;
  return std::exchange(backoff_, std::min(backoff_ * 2, kReopenBackoffMax));
}

void Line::open_at_once(TimePoint now) {
  if (state_.phase() != LinkPhase::closed && state_.phase() != LinkPhase::babbling) return;
  now_ = now;
  change(LinkEvent::stop_waits, now);
  link_.reopen(Duration::zero());
}

void Line::disconnect(const std::string& why, TimePoint now) {
  change(LinkEvent::lost, now);
  shut(why, now);
}

void Line::shut(const std::string& why, TimePoint now) {
  barrier_.reset();
  reservations_.clear();
  framer_.clear();
  const Problem lost = problem_of(Reason::link_down, "the line to the controller is down: " + why, {});
  if (doubted_waiting_) {
    for (auto& answer : doubted_waiting_->answers) answer.deliver(*doubted_);
    doubted_waiting_.reset();
    doubted_.reset();
  }
  if (in_flight_) {
    finish({.written = true, .problem = lost}, ExchangeEnded::Outcome::link_lost, now);
  }
  withdraw([](const ExchangeRequest&) { return true; }, lost);
  listener_.line_lost(why, now);
  link_.reopen(pause_before_reopening());
}

void Line::open(AxisSet controllable, TimePoint now) {
  now_ = now;
  if (!change(LinkEvent::handshake_passed, now)) return;
  continuity_.begin(now);
  trusted_ = answering_;
  controllable_ = controllable;
  listener_.line_trusted(now);
  backoff_ = kReopenBackoffMin;
  pump(now);
}

void Line::confirm_no_restart(TimePoint now) {
  now_ = now;
  if (!change(LinkEvent::same_controller, now)) return;
  listener_.same_controller(now);
  continuity_.begin(now);
  learned(LineLearned::What::same_controller);
  pump(now);
}

OneShot<ExchangeResult> Line::exchange(ExchangeRequest request, TimePoint now) {
  now_ = now;
  OneShot<ExchangeResult> answer(executor_);
  const bool is_stop = request.lane == Lane::stop;
  // Lines of the handshake stay queued: their refusal would look like a failed handshake.
  if (sealed_ && !is_stop && !request.handshake) {
    answer.deliver({.written = false, .problem = *sealed_});
    return answer;
  }
  if (!state_.port_open()) {
    const Problem down = problem_of(Reason::link_down, "the line to the controller is down", request.command.line);
    answer.deliver({.written = false, .problem = down});
    return answer;
  }
  if (request.command.row->effect == Effect::question) {
    WaitingPtr same;
    queue_.for_each([&](const WaitingPtr& waiting) {
      const auto& other = waiting->request;
      const bool same_line = other.command.line == request.command.line || !guarded(Guard::shared_questions);
      if (same_line && other.lane == request.lane && other.handshake == request.handshake && !other.closed &&
          !request.closed) {
        same = waiting;
      }
    });
    if (same) {
      same->request.not_after = std::max(same->request.not_after, request.not_after);
      same->answers.push_back(answer);
      return answer;
    }
  }
  const Lane lane = guarded(Guard::stop_lane) || !is_stop ? request.lane : Lane::poll;
  // The gate bounds a motion's lines, so they need no share and must not fail here.
  const bool shares = !request.identity.empty();
  const std::string turn = shares ? request.identity : request.caller;
  auto waiting = std::make_shared<Waiting>(Waiting{std::move(request), {answer}, now});
  using Queue = LaneQueue<WaitingPtr>;
  const auto queued = queue_.push(lane, turn, waiting, shares ? Queue::kShareMax : Queue::kLaneMax);
  if (!queued) {
    Problem full = queued.error();
    full.sent = waiting->request.command.line;
    answer.deliver({.written = false, .problem = std::move(full)});
    return answer;
  }
  if (is_stop && barrier_) send_stops_now(now);
  pump(now);
  return answer;
}

void Line::withdraw(const std::function<bool(const ExchangeRequest&)>& chosen, const Problem& problem) {
  queue_.drain([&](const WaitingPtr& waiting) { return chosen(waiting->request); },
               [&](const WaitingPtr& waiting) {
                 Problem reported = problem;
                 reported.sent = waiting->request.command.line;
                 for (auto& answer : waiting->answers) {
                   answer.deliver({.written = false, .problem = reported});
                 }
               });
}

void Line::seal(const Problem& problem) {
  sealed_ = problem;
  withdraw([](const ExchangeRequest& request) { return request.lane != Lane::stop && !request.handshake; }, problem);
}

MotionId Line::starting() const {
  const bool starts = in_flight_ && in_flight_->waiting->request.command.row->moves();
  return starts ? in_flight_->waiting->request.motion : 0;
}

void Line::expire(TimePoint now) {
  const auto late = [now](const WaitingPtr& waiting) {
    return waiting->request.not_after < now && guarded(Guard::waiting_lines_expire);
  };
  queue_.drain(late, [&](const WaitingPtr& waiting) {
    const Problem problem = why_expired(waiting->request);
    listener_.line_event(TimeLimitPassed{TimeLimitPassed::Kind::queue}, now);
    for (auto& answer : waiting->answers) answer.deliver({.written = false, .problem = problem});
  });
}

Problem Line::why_expired(const ExchangeRequest& request) const {
  const auto& line = request.command.line;
  if (!state_.port_open()) {
    return {.reason = Reason::link_down,
            .message = "the line to the controller is down",
            .hint = "see `axisctl status` for the reason",
            .sent = line};
  }
  if (!conflicts(request).empty()) {
    return {
        .reason = Reason::completion_outstanding,
        .message =
            "an axis number may still come over the line, and could not be distinguished from this command's answer",
        .hint = "ask again once the motion has ended",
        .sent = line};
  }
  if (!reservations_.empty() && request.lane > Lane::path_refill) {
    return {.reason = Reason::deadline_passed,
            .message = "the segments of a running path are so short that the line had no time for this command",
            .hint = "ask again once the path has ended, or give it longer segments",
            .sent = line};
  }
  return {.reason = Reason::deadline_passed,
          .message = "the time allowed for this command ran out before the line was free",
          .hint = "allow more time, or try again",
          .sent = line};
}

void Line::advance(TimePoint now) {
  now_ = now;
  if (barrier_) {
    const int outstanding_before = outstanding();
    barrier_->advance(now);
    if (outstanding() > outstanding_before) listener_.line_event(TimeLimitPassed{TimeLimitPassed::Kind::probe}, now);
    barrier_moved(now);
  } else if (in_flight_ && now >= in_flight_->limit) {
    listener_.line_event(TimeLimitPassed{TimeLimitPassed::Kind::reply}, now);
    drop_unended(now);  // otherwise the first reply in the barrier would complete that line
    const auto& sent = in_flight_->waiting->request.command.line;
    Problem late{.reason = Reason::reply_timed_out,
                 .message = fmt::format("\"{}\" was not answered in time", sent),
                 .sent = sent};
    const std::string why = late.message;
    enter_barrier({.written = true, .problem = std::move(late)}, ExchangeEnded::Outcome::timed_out, why, now);
  }
  expire(now);
  pump(now);
}

std::optional<TimePoint> Line::next_deadline(TimePoint now) const {
  std::optional<TimePoint> next;
  const auto sooner = [&next](TimePoint at) {
    if (!next || at < *next) next = at;
  };
  if (barrier_) sooner(barrier_->next_deadline());
  if (in_flight_) sooner(in_flight_->limit);
  if (can_send()) {
    TimePoint held = after_refused_stop_.value_or(now);
    if (partial_since_) held = std::max(held, *partial_since_ + kPartialLineLimit);
    if (held > now || partial_since_) sooner(held);
    const auto expiry = reservations_.next_expiry(now);
    if (expiry) sooner(*expiry);
    if (const auto settles = conflicts_settle_from()) {
      const TimePoint at = std::max(*settles, held);
      sooner(at <= now && expiry ? *expiry : at);
    }
  }
  queue_.for_each([&](const WaitingPtr& waiting) { sooner(waiting->request.not_after + Duration(1)); });
  return next;
}

Barrier::Limits Line::barrier_limits() const {
  const Duration longest_reply = timing_.time_of(LineTiming::kReplyBytesMax);
  return {profile_.reply_limit + longest_reply, std::max(kBarrierSilenceMin, 3 * longest_reply)};
}

// Extends the silence after a reconnect: a slow controller may still reply to lines of the previous connection.
Barrier::Limits Line::connect_limits() {
  Barrier::Limits limits = barrier_limits();
  const bool before = std::exchange(connected_before_, true);
  if (before && guarded(Guard::silence_after_reconnect)) limits.silence = std::max(limits.silence, limits.reply);
  return limits;
}

std::unique_ptr<Barrier> Line::make_barrier(std::string line_in_doubt, Barrier::Limits limits) {
  return std::make_unique<Barrier>(
      std::move(line_in_doubt), limits, outstanding_, [this](const Identity& identity) { return is_known(identity); },
      [this](std::string_view line, TimePoint) { write_line(line); });
}

// Reports whether the identity is that of the configured controller, or of the controller that was connected before.
bool Line::is_known(const Identity& identity) const {
  const std::string& serial_number = profile_.serial_number.empty() ? trusted_ : profile_.serial_number;
  return identity.model == profile_.model && (serial_number.empty() || identity.serial_number == serial_number);
}

}  // namespace axisgate::shrc203
