#include "device/shrc203/state/motion_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/core/spans.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

OneShot<Result<void>> MotionGate::enter(MotionId id, AxisSet axes, const std::string& caller, TimePoint not_after) {
  OneShot<Result<void>> answer(tasks_.executor());
  const AxisSet wanted = busy_scope_ == Scope::controller ? kAllAxes : axes;
  const auto queued = queue_.push(Lane::motion, caller, Entry{id, wanted, caller, not_after, tasks_.now(), answer},
                                  LaneQueue<Entry>::kShareMax);
  if (!queued) {
    answer.deliver(queued);
    return answer;
  }
  admit();
  return answer;
}

void MotionGate::leave(MotionId id) {
  inside_.erase(id);
  admit();
}

AxisSet MotionGate::axes_of(MotionId id) const {
  const auto found = inside_.find(id);
  return found == inside_.end() ? AxisSet() : found->second;
}

void MotionGate::hold(AxisSet axes) {
  if (guarded(Guard::stops_hold_motions)) held_.push_back(axes);
}

void MotionGate::let_go(AxisSet axes) {
  const auto found = std::ranges::find(held_, axes);
  if (found != held_.end()) held_.erase(found);
  admit();
}

void MotionGate::withdraw(const std::function<bool(MotionId)>& chosen, const Problem& problem) {
  queue_.drain([&](const Entry& entry) { return chosen(entry.id); },
               [&](Entry entry) { entry.answer.deliver(tl::unexpected<Problem>(problem)); });
  admit();  // the withdrawn motions may have kept others out
}

void MotionGate::expire(const std::function<std::string(AxisSet)>& inside) {
  const auto late = [now = tasks_.now()](const Entry& entry) {
    return entry.not_after < now && guarded(Guard::waiting_motions_expire);
  };
  queue_.drain(late, [&](Entry entry) {
    const std::string had_them = inside(entry.axes);
    entry.answer.deliver(fail(Reason::deadline_passed,
                              "the time allowed passed before the motion had its turn: " +
                                  (had_them.empty() ? what_goes_first(entry) : had_them),
                              "to wait longer, set a later `not_after`; or stop it"));
  });
  admit();
}

// Returns text about what goes before the entry. Call if no motion has the entry's axes.
std::string MotionGate::what_goes_first(const Entry& entry) const {
  if (held().touches(entry.axes)) return fmt::format("a stop of {} is not over yet", to_string(held()));
  const auto waited = [now = tasks_.now()](TimePoint since) { return for_people(now - since); };
  if (const auto question = question_turn_.question()) {
    return fmt::format("\"{}\" of {} has waited for {} and goes first", question->line, question->caller,
                       waited(question->since));
  }
  std::string first = "others had their turns";
  queue_.for_each([&](const Entry& other) {
    if (!other.axes.touches(entry.axes) || other.since > overdue_since()) return;
    first = fmt::format("motion {} of {} has waited for {} for {} and goes first", other.id, other.caller,
                        to_string(other.axes), waited(other.since));
  });
  return first;
}

std::optional<TimePoint> MotionGate::next_deadline() const {
  std::optional<TimePoint> next = question_turn_.limit();
  queue_.for_each([&](const Entry& entry) {
    if (entry.not_after == TimePoint::max()) return;
    const TimePoint at = entry.not_after + Duration(1);
    if (!next || at < *next) next = at;
  });
  return next;
}

AxisSet MotionGate::held() const {
  AxisSet axes;
  for (const AxisSet one : held_) axes = axes | one;
  return axes;
}

AxisSet MotionGate::busy() const {
  AxisSet axes = held();
  if (!guarded(Guard::one_motion_at_a_time)) return axes;
  for (const auto& [id, one] : inside_) axes = axes | one;
  return axes;
}

// Returns the time limit of overtaking: motions that have waited since then, or longer, are not overtaken.
TimePoint MotionGate::overdue_since() const {
  return guarded(Guard::motions_not_overtaken) ? tasks_.now() - kTurnAfter : TimePoint::min();
}

// Returns the motions that need an axis for which another motion has waited too long, and whose turn comes after that
// motion's.
std::set<MotionId> MotionGate::overtaking(AxisSet busy) const {
  std::set<MotionId> later;
  const TimePoint overdue = overdue_since();
  if (!queue_.any_of([&](const Entry& entry) { return busy.touches(entry.axes) && entry.since <= overdue; }))
    return later;
  AxisSet kept;
  queue_.for_each_in_turn(Lane::motion, [&](const Entry& entry) {
    const bool after = kept.touches(entry.axes);
    if (after) later.insert(entry.id);
    if ((after || busy.touches(entry.axes)) && entry.since <= overdue) kept = kept | entry.axes;
  });
  return later;
}

void MotionGate::admit() {
  while (true) {
    const AxisSet taken = busy();
    const std::set<MotionId> later = overtaking(taken);
    const auto may_enter = [&](const Entry& entry) { return !taken.touches(entry.axes) && !later.contains(entry.id); };
    if (!queue_.any_of(may_enter)) return question_turn_.keeps_nobody_out();
    if (question_turn_.keeps_out(tasks_.now())) return;
    auto entry = queue_.take(may_enter);
    inside_[entry->id] = entry->axes;
    entry->answer.deliver({});
  }
}

}  // namespace axisgate::shrc203
