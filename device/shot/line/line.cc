#include "device/shot/line/line.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shot/limits.h"

namespace axisgate::shot {

Line::Line(const Model& model, const Profile& profile, ByteLink& link, Executor& executor, LineListener& listener)
    : model_(model),
      link_(link),
      executor_(executor),
      listener_(listener),
      backoff_(kReopenBackoffMin),
      timing_(profile.baud, model.axis_count()),
      flood_(profile.baud),
      completions_(model.axis_count()),
      recovery_(model, profile, *this, listener_, link_state_, timing_, controllable_, completions_, continuity_,
                exchange_, second_reply_, waiting_, wire_, results_),
      sending_(model, profile, listener_, link_state_, timing_, incoming_, completions_, continuity_, reservations_,
               exchange_, second_reply_, waiting_, wire_) {}

bool Line::change(LinkEvent event, TimePoint now) {
  const LinkPhase before = link_state_.phase();
  if (link_state_.happened(event)) return true;
  now_ = now;
  illegal("link", name(before), name(event));
  return false;
}

void Line::illegal(std::string_view machine, std::string_view state, std::string_view event) {
  listener_.line_event(IllegalTransition{machine, state, event}, now_);
  disconnect(fmt::format("internal error: {} while the {} was {}", event, machine, state), now_);
}

void Line::link_up(TimePoint now) {
  now_ = now;
  if (!change(LinkEvent::port_opened, now)) return;
  listener_.line_opened(now);
  incoming_.clear();
  second_reply_ = {};
  timing_.connected();
  flood_.connected();
  completions_.connected();
  continuity_.connected();
  recovery_.connect(now);
}

void Line::link_down(TimePoint now, std::string_view why) {
  now_ = now;
  if (link_state_.port_open()) return disconnect(std::string(why), now);
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
  if (link_state_.phase() != LinkPhase::closed && link_state_.phase() != LinkPhase::babbling) return;
  now_ = now;
  change(LinkEvent::stop_waits, now);
  link_.reopen(Duration::zero());
}

void Line::disconnect(const std::string& why, TimePoint now) { close(LinkEvent::lost, why, now); }

void Line::close(LinkEvent event, const std::string& why, TimePoint now) {
  change(event, now);
  reservations_.clear();
  incoming_.clear();
  const Problem lost{.reason = Reason::link_down, .message = "the line to the controller is down: " + why};
  if (exchange_.in_flight() != nullptr) {
    results_.finish({.written = true, .problem = lost}, ExchangeEnded::Outcome::link_lost, now);
  }
  if (const auto doubted = exchange_.line_closed()) doubted->waiting->deliver(doubted->result);
  waiting_.withdraw([](const ExchangeRequest&) { return true; }, lost);
  listener_.line_lost(why, now);
  link_.reopen(pause_before_reopening());
}

void Line::open(AxisSet controllable, TimePoint now) {
  now_ = now;
  if (!change(LinkEvent::handshake_passed, now)) return;
  continuity_.begin(now);
  recovery_.trust();
  controllable_ = controllable;
  listener_.line_trusted(now);
  backoff_ = kReopenBackoffMin;
  sending_.pump(now);
}

void Line::confirm_no_restart(TimePoint now) {
  now_ = now;
  if (!change(LinkEvent::same_controller, now)) return;
  listener_.same_controller(now);
  continuity_.begin(now);
  listener_.line_event(LineLearned{LineLearned::What::same_controller, {}}, now);
  sending_.pump(now);
}

OneShot<ExchangeResult> Line::exchange(ExchangeRequest request, TimePoint now) {
  now_ = now;
  OneShot<ExchangeResult> answer(executor_);
  const bool is_stop = request.lane == Lane::stop;
  if (!waiting_.add(std::move(request), answer, now)) return answer;
  if (is_stop) recovery_.send_stops(now);
  sending_.pump(now);
  return answer;
}

MotionId Line::starting() const {
  const InFlight* const line = exchange_.in_flight();
  return line != nullptr && line->request().command.row->moves() ? line->request().motion : 0;
}

void Line::receive(std::string_view bytes, TimePoint now) {
  now_ = now;
  receiving_.receive(bytes, now);
  sending_.pump(now);
}

void Line::advance(TimePoint now) {
  now_ = now;
  if (exchange_.barrier() != nullptr) {
    recovery_.advance(now);
  } else {
    receiving_.check_time_limit(now);
  }
  waiting_.expire(now);
  sending_.pump(now);
}

std::optional<TimePoint> Line::next_deadline(TimePoint now) const {
  std::optional<TimePoint> next = sending_.next_deadline(now);
  const auto sooner = [&next](std::optional<TimePoint> at) {
    if (at && (!next || *at < *next)) next = at;
  };
  if (const Barrier* const barrier = exchange_.barrier()) sooner(barrier->next_deadline());
  if (const InFlight* const line = exchange_.in_flight()) sooner(line->limit);
  sooner(waiting_.next_expiry());
  return next;
}

void Line::keep_free(MotionId path, TimePoint due, TimePoint now) {
  now_ = now;
  reservations_.keep(path, due);
  sending_.pump(now);
}

void Line::release(MotionId path, TimePoint now) {
  now_ = now;
  reservations_.release(path);
  sending_.pump(now);
}

void Line::ready(AxisSet axes, TimePoint now) {
  const AxisSet changed = completions_.ready(axes, now);
  if (!changed.empty()) listener_.line_event(LineLearned{LineLearned::What::ready, changed}, now);
}

void Line::busy(AxisSet axes, TimePoint now) {
  const AxisSet changed = completions_.busy(axes);
  if (!changed.empty()) listener_.line_event(LineLearned{LineLearned::What::busy, changed}, now);
}

}  // namespace axisgate::shot
