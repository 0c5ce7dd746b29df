#include "device/shrc203/state/motion_gate.h"

#include <algorithm>

#include "device/core/guard.h"

namespace axisgate::shrc203 {

OneShot<Result<void>> MotionGate::enter(MotionId id, AxisSet axes, const std::string& caller, TimePoint not_after) {
  OneShot<Result<void>> answer(executor_);
  const AxisSet wanted = busy_scope_ == Scope::controller ? AxisSet::all() : axes;
  if (!queue_.push(Lane::motion, caller, Entry{id, wanted, not_after, answer})) {
    answer.deliver(fail(Reason::queue_full, "too many motions wait for this controller already",
                        "try again when some have ended"));
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
}

void MotionGate::expire(TimePoint now) {
  queue_.drain([now](const Entry& entry) { return entry.not_after < now && guarded(Guard::waiting_motions_expire); },
               [](Entry entry) {
                 entry.answer.deliver(fail(Reason::deadline_passed,
                                           "other motions kept the stage busy until the time allowed had passed",
                                           "allow more time (not_after), or try again"));
               });
}

std::optional<TimePoint> MotionGate::next_deadline() const {
  std::optional<TimePoint> next;
  queue_.for_each([&](const Entry& entry) {
    if (entry.not_after == TimePoint::max()) return;
    const TimePoint at = entry.not_after + Duration(1);
    if (!next || at < *next) next = at;
  });
  return next;
}

void MotionGate::admit() {
  while (true) {
    AxisSet taken;
    if (guarded(Guard::one_motion_at_a_time)) {
      for (const auto& [id, axes] : inside_) taken = taken | axes;
    }
    for (const AxisSet axes : held_) taken = taken | axes;
    auto entry = queue_.take([taken](const Entry& waiting) { return !taken.touches(waiting.axes); });
    if (!entry) return;
    inside_[entry->id] = entry->axes;
    entry->answer.deliver({});
  }
}

}  // namespace axisgate::shrc203
