#include "device/rml1/sending/sender.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "device/core/transitions.h"
#include "device/jobs/guard.h"
#include "device/rml1/sending/commands.h"
#include "device/rml1/sending/cut.h"
#include "device/rml1/sending/delivery.h"

namespace axisgate::rml1 {
namespace {

constexpr std::array<std::string_view, kSendEvents> kSendEventNames = {
    "start", "pause", "resume", "raise", "all_written", "all_executed", "abort", "abort_left", "line_lost"};

}  // namespace

std::string_view name(SendEvent event) { return kSendEventNames.at(static_cast<std::size_t>(event)); }

Sender::Sender(std::string_view job, const Timeline& timeline, const Profile& profile,
               const jobs::SendSettings& settings, const SendPlan& plan, const MillLine& mill)
    : job_(job),
      timeline_(timeline),
      profile_(profile),
      settings_(settings),
      plan_(plan),
      line_(mill.line),
      abort_(mill.abort),
      violations_(mill.violations),
      slowest_(timeline, &Step::slowest_s, plan.slack),
      fastest_(timeline, &Step::least_s, 1),
      meter_(timeline, settings.buffer + settings.converter),
      cutter_(job, plan.window) {}

std::optional<jobs::SenderState> next(jobs::SenderState state, SendEvent event) {
  using enum jobs::SenderState;
  using Change = Transition<jobs::SenderState, SendEvent>;
  static constexpr std::array kTable = {
      Change{ready, SendEvent::start, sending},           Change{sending, SendEvent::pause, paused},
      Change{paused, SendEvent::resume, sending},         Change{sending, SendEvent::raise, raising},
      Change{paused, SendEvent::raise, raising},          Change{raising, SendEvent::all_executed, raised},
      Change{sending, SendEvent::all_written, finishing}, Change{finishing, SendEvent::all_executed, fed},
      Change{sending, SendEvent::abort, aborting},        Change{paused, SendEvent::abort, aborting},
      Change{finishing, SendEvent::abort, aborting},      Change{raising, SendEvent::abort, aborting},
      Change{aborting, SendEvent::abort_left, aborted},   Change{ready, SendEvent::line_lost, lost},
      Change{sending, SendEvent::line_lost, lost},        Change{paused, SendEvent::line_lost, lost},
      Change{finishing, SendEvent::line_lost, lost},      Change{raising, SendEvent::line_lost, lost},
      Change{aborting, SendEvent::line_lost, lost},
  };
  return next_in(kTable, state, event);
}

// Changes the state. Returns false, without any effect, if the state does not allow the event.
bool Sender::request(SendEvent event) {
  const auto to = next(state_, event);
  if (to) state_ = *to;
  return to.has_value();
}

void Sender::change(SendEvent event) {
  if (!request(event)) violations_.illegal("sender", name(state_), name(event));
}

void Sender::start(TimePoint now) {
  if (request(SendEvent::start)) send(now);
}

void Sender::pause() { request(SendEvent::pause); }

void Sender::resume(TimePoint now) {
  learn(now);
  if (!request(SendEvent::resume)) return;
  meter_.interrupted();
  send(now);
}

void Sender::raise() {
  if (request(SendEvent::raise)) line_.write(raise_commands(profile_, rests_after_written()));
}

// Reports whether the spindle is stationary when the mill has executed all written bytes.
bool Sender::rests_after_written() const {
  const auto& steps = timeline_.steps();
  const auto next = std::ranges::upper_bound(steps, cutter_.begin(), {}, &Step::end);
  return next == steps.begin() || !std::prev(next)->turning;
}

void Sender::line_lost() { request(SendEvent::line_lost); }

// The abort follows the written part of the job, which ends with a complete command or set of coordinates.
void Sender::abort(TimePoint now) {
  learn(now);
  const bool rests = may_rest(now);
  if (guarded(jobs::MillGuard::abort_ends_job) && !request(SendEvent::abort)) return;
  abort_.write(rests, now);
}

bool Sender::abort_may_be_dropped() const {
  return !settings_.flow_control && cutter_.begin() + abort_commands(profile_, true).size() > settings_.buffer;
}

void Sender::advance(TimePoint now) {
  learn(now);
  if (state_ == jobs::SenderState::sending) send(now);
  if (state_ == jobs::SenderState::aborting) {
    abort_.advance(now);
    if (!abort_.waits()) change(SendEvent::abort_left);
  }
  if (state_ == jobs::SenderState::finishing && all_is_executed(now)) change(SendEvent::all_executed);
  if (state_ == jobs::SenderState::raising && has_raised(now)) change(SendEvent::all_executed);
}

// The mill begins to raise the tool when it has executed the sent bytes of the job.
bool Sender::has_raised(TimePoint now) {
  if (is_blocked() || slowest_.executed(now) < cutter_.begin()) {
    raised_at_.reset();
    return false;
  }
  if (!raised_at_) raised_at_ = now + longest_move(profile_.z_mm, profile_.speed.z_maximum, profile_, plan_.slack);
  return now >= *raised_at_;
}

// A mill that has executed everything has room in its buffer. So if the line is blocked, some bytes were not executed.
bool Sender::all_is_executed(TimePoint now) {
  if (guarded(jobs::MillGuard::fed_when_arrived) && is_blocked()) return false;
  return !guarded(jobs::MillGuard::fed_by_the_slowest) || slowest_.executed(now) >= job_.size();
}

bool Sender::is_blocked() const { return line_.unsent() > 0 || line_.held(); }

void Sender::send(TimePoint now) {
  while (cutter_.begin() < job_.size()) {
    if (guarded(jobs::MillGuard::one_command_unsent) && line_.unsent() > 0) return;
    if (guarded(jobs::MillGuard::nothing_while_held) && line_.held()) return;
    if (guarded(jobs::MillGuard::window) && !has_room(now)) return;
    write(now);
  }
  change(SendEvent::all_written);
}

void Sender::write(TimePoint now) {
  const std::size_t begin = cutter_.begin(), end = cutter_.end();
  line_.write(job_.substr(begin, end - begin));
  leaves_ = std::max(leaves_, now) + transmit_time(end - begin, settings_.baud);
  arrives_ = std::max(arrives_, now) + transmit_time(end - begin, settings_.baud);
  slowest_.arrived(end, arrives_);
  fastest_.arrived(end, now);
  cutter_.next();
}

bool Sender::has_room(TimePoint now) {
  if (settings_.streaming == jobs::Streaming::full) return true;
  const std::uint64_t executed = slowest_.executed(now);
  return executed == cutter_.begin() || cutter_.end() - executed <= plan_.window;
}

// The mill has read all bytes that have left the host, except as many as its buffer and a converter can contain. Only
// flow control makes this certain: without it, a mill loses bytes for which it has no room.
void Sender::learn(TimePoint now) {
  learn_what_waits(now);
  measure(now);
  if (!heeds_flow_control()) return;
  const std::size_t left = cutter_.begin() - std::min(line_.unsent(), cutter_.begin());
  const std::size_t between = settings_.converter, unread = settings_.buffer + between;
  if (left > unread) slowest_.has_read(left - unread, now);
  if (left > between) taken_ = std::max<std::uint64_t>(taken_, left - between);
}

// Reports whether flow control keeps bytes that leave the host from being lost. Without flow control, and after an
// abort (which may ignore it), a full buffer may lose bytes; a lost line loses bytes too.
bool Sender::heeds_flow_control() const {
  return settings_.flow_control && state_ != jobs::SenderState::aborting && !is_end(state_);
}

// A line that the mill has stopped shows that the mill has bytes to read. The host cannot see XOFF or a stop by the
// printer driver; it sees only that bytes do not leave.
void Sender::measure(TimePoint now) {
  const bool sends = state_ == jobs::SenderState::sending || state_ == jobs::SenderState::finishing;
  if (settings_.streaming != jobs::Streaming::full || !sends) return;
  const std::size_t unsent = line_.unsent();
  if (!line_.held() && (unsent == 0 || now <= leaves_ + kLook)) return;
  meter_.stopped(cutter_.begin() - std::min(unsent, cutter_.begin()), now);
}

// Notes which bytes have not arrived: those in the host, and, if the line is held, those that may be in a converter.
void Sender::learn_what_waits(TimePoint now) {
  if (!guarded(jobs::MillGuard::counted_from_arrival) || !is_blocked()) return;
  const std::size_t waits = line_.unsent() + (line_.held() ? settings_.converter : 0);
  slowest_.not_arrived(cutter_.begin() - std::min(waits, cutter_.begin()), transmit_time(1, settings_.baud), now);
  arrives_ = std::max(arrives_, now + transmit_time(waits, settings_.baud));
}

// Reports whether the spindle may be stationary when the abort reaches the mill. Checks each step that the mill may be
// executing then.
bool Sender::may_rest(TimePoint now) {
  const auto& steps = timeline_.steps();
  const auto next = std::ranges::upper_bound(steps, slowest_.executed(now), {}, &Step::end);
  if (next == steps.begin()) return true;
  // The first step whose bytes were not all written.
  const auto unknown = std::ranges::upper_bound(steps, cutter_.begin(), {}, &Step::end);
  if (unknown == steps.end() && !timeline_.turns_at_end()) return true;
  const auto last = unknown == steps.end() ? unknown : unknown + 1;
  return !std::all_of(next - 1, last, [](const Step& one) { return one.turning; });
}

std::optional<TimePoint> Sender::next_deadline(TimePoint now) const {
  switch (state_) {
    case jobs::SenderState::sending:
      if (is_blocked()) return now + until_next_look();
      return settings_.streaming == jobs::Streaming::full ? now : next_check(room_at(), now);
    case jobs::SenderState::aborting:
      return now + kLook;
    case jobs::SenderState::finishing:
      return is_blocked() ? now + until_next_look() : next_check(slowest_.when(job_.size()), now);
    case jobs::SenderState::raising:
      if (is_blocked()) return now + until_next_look();
      return raised_at_ ? *raised_at_ : next_check(slowest_.when(cutter_.begin()), now);
    default:
      return std::nullopt;
  }
}

// Returns kLook, or the time that the unsent bytes need if that is shorter, so that the line is not idle for longer
// than necessary.
Duration Sender::until_next_look() const {
  return line_.unsent() > 0 ? std::min(kLook, transmit_time(line_.unsent(), settings_.baud)) : kLook;
}

// Returns `due`, or an earlier time while bytes of the last command may be in a converter: if the line is held, they
// stay there.
TimePoint Sender::next_check(TimePoint due, TimePoint now) const {
  return arrives_ > now ? std::min(due, now + kLook) : due;
}

// Returns the time at which the window has room for the next command.
TimePoint Sender::room_at() const {
  const std::size_t over = cutter_.end() > plan_.window ? cutter_.end() - plan_.window : 0;
  return slowest_.when(std::min<std::uint64_t>(over, cutter_.begin()));
}

std::uint64_t Sender::executed_for_certain(TimePoint now) {
  const std::uint64_t by_profile = slowest_.executed(now);
  if (!is_blocked()) return by_profile;
  const std::size_t left = cutter_.begin() - std::min(line_.unsent(), cutter_.begin());
  return std::min<std::uint64_t>(by_profile, left - std::min(left, settings_.buffer + settings_.converter));
}

jobs::SendProgress Sender::progress(TimePoint now) {
  learn(now);
  const std::uint64_t executed = slowest_.executed(now);
  taken_ = std::max(taken_, executed);
  return {cutter_.begin(), std::min(line_.unsent(), cutter_.begin()), taken_, executed, fastest_.executed(now)};
}

}  // namespace axisgate::rml1
