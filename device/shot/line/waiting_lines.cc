#include "device/shot/line/waiting_lines.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/shot/command/reply.h"

namespace axisgate::shot {

bool WaitingLines::add(ExchangeRequest request, OneShot<ExchangeResult> answer, TimePoint now) {
  const auto refuse = [&answer](Problem problem) {
    answer.deliver({.written = false, .problem = std::move(problem)});
    return false;
  };
  const bool is_stop = request.lane == Lane::stop;
  // Lines of the handshake stay queued: their refusal would look like a failed handshake.
  if (sealed_ && !is_stop && !request.handshake) return refuse(*sealed_);
  if (!link_.port_open()) {
    return refuse(
        {.reason = Reason::link_down, .message = "the line to the controller is down", .sent = request.command.line});
  }
  if (const WaitingPtr same = same_question(request)) {
    same->request.not_after = std::max(same->request.not_after, request.not_after);
    same->answers.push_back(answer);
    return false;
  }
  const Lane lane = guarded(Guard::stop_lane) || !is_stop ? request.lane : Lane::poll;
  // The gate bounds a motion's lines, so they need no share and must not fail here.
  const bool shares = !request.identity.empty();
  const std::string turn = shares ? request.identity : request.caller;
  auto waiting = std::make_shared<Waiting>(Waiting{std::move(request), {answer}, now});
  using Queue = LaneQueue<WaitingPtr>;
  const auto queued = queue_.push(lane, turn, waiting, shares ? Queue::kShareMax : Queue::kLaneMax);
  if (queued) return true;
  Problem full = queued.error();
  full.sent = waiting->request.command.line;
  return refuse(std::move(full));
}

// Returns a waiting line that asks the same in the same lane; null if there is none. A question of a motion is
// shared only within the motion, and one that needs a right of its own is never shared: one caller may lose the right
// while the other keeps it.
WaitingPtr WaitingLines::same_question(const ExchangeRequest& request) const {
  WaitingPtr same;
  if (request.command.row->effect != Effect::question) return same;
  queue_.for_each([&](const WaitingPtr& waiting) {
    const auto& other = waiting->request;
    const bool same_line = other.command.line == request.command.line || !guarded(Guard::shared_questions);
    const bool same_right = other.motion == request.motion && other.uses.empty() && request.uses.empty();
    const bool closed = other.closed || request.closed;
    if (same_line && same_right && !closed && other.lane == request.lane && other.handshake == request.handshake) {
      same = waiting;
    }
  });
  return same;
}

WaitingPtr WaitingLines::take(const Chosen& may_go, TimePoint now) {
  while (auto next = queue_.take([&](const WaitingPtr& waiting) { return may_go(*waiting); })) {
    const ExchangeRequest& request = (*next)->request;
    const bool asks = (request.motion != 0 || !request.uses.empty()) && !request.tidies;
    const auto refusal = asks ? listener_.may_write(request, now) : std::nullopt;
    if (!refusal) return *next;
    (*next)->deliver({.written = false, .problem = *refusal});
  }
  return nullptr;
}

void WaitingLines::take_stops(const std::function<void(const WaitingPtr&)>& taken) {
  queue_.drain([](const WaitingPtr& waiting) { return waiting->request.lane == Lane::stop; }, taken);
}

void WaitingLines::withdraw(const std::function<bool(const ExchangeRequest&)>& chosen, const Problem& problem) {
  queue_.drain([&](const WaitingPtr& waiting) { return chosen(waiting->request); },
               [&](const WaitingPtr& waiting) {
                 Problem reported = problem;
                 reported.sent = waiting->request.command.line;
                 waiting->deliver({.written = false, .problem = reported});
               });
}

void WaitingLines::expire(TimePoint now) {
  const auto late = [now](const WaitingPtr& waiting) {
    return waiting->request.not_after < now && guarded(Guard::waiting_lines_expire);
  };
  queue_.drain(late, [&](const WaitingPtr& waiting) {
    const Problem problem = why_expired(waiting->request);
    listener_.line_event(TimeLimitPassed{TimeLimitPassed::Kind::queue}, now);
    waiting->deliver({.written = false, .problem = problem});
  });
}

void WaitingLines::seal(const Problem& problem) {
  sealed_ = problem;
  withdraw([](const ExchangeRequest& request) { return request.lane != Lane::stop && !request.handshake; }, problem);
}

void WaitingLines::for_each(const std::function<void(const Waiting&)>& look) const {
  queue_.for_each([&](const WaitingPtr& waiting) { look(*waiting); });
}

std::optional<TimePoint> WaitingLines::next_expiry() const {
  std::optional<TimePoint> next;
  queue_.for_each([&](const WaitingPtr& waiting) {
    const TimePoint at = waiting->request.not_after + Duration(1);
    if (!next || at < *next) next = at;
  });
  return next;
}

// Returns the axes among `axes` whose completions could be taken for the reply.
AxisSet WaitingLines::ambiguous(const ExchangeRequest& request, AxisSet axes) const {
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

std::optional<TimePoint> WaitingLines::conflicts_settle_from() const {
  std::optional<TimePoint> earliest;
  queue_.for_each([&](const WaitingPtr& waiting) {
    const AxisSet axes = conflicts(waiting->request);
    const auto from = axes.empty() ? std::nullopt : completions_.settles_from(axes);
    if (from && (!earliest || *from < *earliest)) earliest = from;
  });
  return earliest;
}

std::optional<HeldQuestion> WaitingLines::held_question() const {
  std::optional<HeldQuestion> oldest;
  if (!link_.trusted() || sealed_) return oldest;
  queue_.for_each([&](const WaitingPtr& waiting) {
    const ExchangeRequest& request = waiting->request;
    if (request.handshake || (oldest && oldest->since <= waiting->asked)) return;
    if (ambiguous(request, controllable_).empty()) return;
    oldest = HeldQuestion{request.command.line, request.caller, waiting->asked};
  });
  return oldest;
}

Problem WaitingLines::why_expired(const ExchangeRequest& request) const {
  const auto& line = request.command.line;
  if (!link_.port_open()) {
    return {.reason = Reason::link_down,
            .message = "the line to the controller is down",
            .hint = "see `GetDevice` for the reason",
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

}  // namespace axisgate::shot
