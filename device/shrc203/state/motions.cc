#include "device/shrc203/state/motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

Motions::Motions(StateStore& store, const Line& line, Registers& registers, Rights& rights, Tasks& tasks,
                 Violations& violations)
    : store_(store),
      registers_(registers),
      rights_(rights),
      tasks_(tasks),
      violations_(violations),
      gate_(tasks, store.profile().busy_scope, [&line] { return line.held_question(); }),
      pace_changed_(tasks.executor()),
      ended_or_left_(tasks.executor()) {}

void Motions::change(LiveMotion& live, MotionEvent event) {
  const MotionPhase before = live.life.phase();
  if (!live.life.happened(event)) violations_.illegal("motion", name(before), name(event));
}

void Motions::jog_changed(LiveMotion& live, JogEvent event) {
  const JogPhase before = live.jog->phase;
  if (const auto to = next(before, event)) {
    live.jog->phase = *to;
  } else {
    violations_.illegal("jog", name(before), name(event));
  }
}

void Motions::end_jog(LiveMotion& live, std::optional<Problem> why) {
  if (!live.jog || live.jog->must_end() || live.life.stop_asked()) return;
  jog_changed(live, JogEvent::must_end);
  live.jog->why = std::move(why);
  live.jog->changed.notify();
}

void Motions::show(LiveMotion& live, MotionState state) {
  if (live.motion.state == state) return;
  live.motion.state = state;
  store_.emit(MotionChanged{live.motion});
}

LiveMotionPtr Motions::create(MotionKind kind, AxisSet axes, RequestContext context, OnStarted started) {
  Motion motion;
  motion.id = ++last_;
  motion.kind = kind;
  motion.axes = axes;
  for (const int axis : axes.list()) motion.results.push_back({axis, {}, {}, false});
  motion.who = context.who;
  motion.request_id = context.request_id;
  motion.created = tasks_.now();
  if (context.not_after == TimePoint{}) context.not_after = tasks_.now() + kMotionStartLimit;
  auto live = std::make_shared<LiveMotion>(tasks_.executor(), std::move(motion), std::move(context));
  live->uses = live->excited = axes;
  live->on_started = std::move(started);
  live_[live->motion.id] = live;
  store_.emit(MotionChanged{live->motion});
  return live;
}

Task<Result<void>> Motions::enter(LiveMotionPtr live, bool prebuffer) {
  const bool alone =
      prebuffer && guarded(Guard::path_owns_prebuffers) && store_.profile().prebuffer_scope == Scope::controller;
  auto entry = gate_.enter(live->motion.id, alone ? kAllAxes : live->uses, live->context.takes_turns_as(),
                           live->context.not_after);
  const auto entered = co_await entry;
  if (!entered) co_return entered;
  change(*live, MotionEvent::entered);
  const RequestContext& by = live->context;
  const Use use{by.who, by.lease, live->uses, live->motion.id, by.session};
  const auto allowed = rights_.still_authorized(use);
  if (!allowed && guarded(Guard::lease_asked_at_turn)) co_return allowed;
  if (auto forbidden = rights_.motion_forbidden(live->motion.axes)) co_return tl::unexpected(*std::move(forbidden));
  const auto meant = rights_.check_epochs(live->context);
  rights_.begin(use, live->motion);
  if (!meant) co_return meant;
  if (live->life.stop_asked() && guarded(Guard::stop_before_preparing)) {
    co_return fail(Reason::stopped, "a stop by " + live->life.stopped_by() + " came before the motion was sent");
  }
  co_return Result<void>();
}

void Motions::written(LiveMotion& live) {
  live.motion.written = true;
  change(live, MotionEvent::written);
}

void Motions::started(LiveMotion& live) {
  if (!live.life.unstarted()) return;
  live.motion.started = tasks_.now();
  store_.unsettle();
  change(live, MotionEvent::started);
  show(live, live.life.shown());
  pace_changed_.notify();
  if (live.jog) live.jog->changed.notify();
  if (auto reported = std::exchange(live.on_started, {})) reported(live.motion);
}

void Motions::due(LiveMotion& live, TimePoint over) {
  live.motion.due = over;
  rights_.due(live.motion.id, over);
}

void Motions::end(LiveMotion& live, MotionState outcome, std::optional<Problem> problem) {
  if (live.life.has_outcome()) return;
  const bool never_started = live.life.unstarted(), wrote = live.life.has_written();
  if (outcome == MotionState::succeeded && live.on_success) live.on_success();
  live.motion.ended = tasks_.now();
  live.motion.problem = std::move(problem);
  if (outcome == MotionState::succeeded || outcome == MotionState::stopped) store_.note_armed(live.motion.axes, false);
  for (auto& result : live.motion.results) {
    result.command_pulses = store_.state().axis(result.axis).position_pulses;
  }
  const bool succeeded = outcome == MotionState::succeeded;
  succeeded ? store_.settle() : store_.unsettle();
  if (!succeeded && wrote && guarded(Guard::registers_unknown_after_failure)) registers_.forget();
  const bool had_turn = live.life.has_turn();
  change(live, had_turn && live.restores() ? MotionEvent::finished_to_restore : MotionEvent::finished);
  show(live, outcome);
  if (auto reported = std::exchange(live.on_started, {})) {
    if (never_started && live.motion.problem && outcome != MotionState::unknown) {
      reported(tl::unexpected(*live.motion.problem));
    } else {
      reported(live.motion);
    }
  }
  const MotionId id = live.motion.id;
  ended_.push_back(live.motion);
  while (ended_.size() > StageController::kMotionsKept) ended_.pop_front();
  const bool leaves = had_turn && live.life.phase() == MotionPhase::ended;
  const bool unseen = outcome == MotionState::unknown && wrote && guarded(Guard::unseen_motion_keeps_its_axes);
  if (unseen) left_moving_[id] = live.motion.axes;
  live_.erase(id);  // `live` may be gone
  if (leaves) {
    has_left(id);
  } else if (had_turn) {
    restoring_[id] = ended_.back().axes;
  }
  ended_or_left_.notify();
}

// Ends the motion's right to its axes, unless they may still be moving.
void Motions::has_left(MotionId id) {
  restoring_.erase(id);
  gate_.leave(id);
  if (!left_moving_.contains(id)) rights_.end(id);
}

void Motions::seen_stationary(AxisSet axes) {
  for (auto left = left_moving_.begin(); left != left_moving_.end();) {
    left->second = left->second - axes;
    if (!left->second.empty()) {
      ++left;
      continue;
    }
    const MotionId id = left->first;
    left = left_moving_.erase(left);
    if (!restoring_.contains(id)) rights_.end(id);
  }
}

AxisSet Motions::left_moving(MotionId id) const {
  const auto left = left_moving_.find(id);
  return left == left_moving_.end() ? AxisSet() : left->second;
}

void Motions::refuse(LiveMotion& live, const Problem& problem) {
  end(live, problem.reason == Reason::stopped ? MotionState::stopped : MotionState::failed, problem);
}

void Motions::disconnect(LiveMotion& live, const Problem& problem) {
  end(live, live.life.stop_asked() ? MotionState::stopped : MotionState::failed, problem);
}

void Motions::leave(LiveMotion& live) {
  if (live.life.phase() == MotionPhase::ended) return;
  change(live, MotionEvent::left);
  has_left(live.motion.id);
  ended_or_left_.notify();
}

void Motions::stop_requested(const RequestContext& by, AxisSet axes) {
  std::vector<Use> waiting;
  for (const auto& [id, live] : live_) {
    if (live->life.has_turn() || live->life.has_outcome() || !live->motion.axes.touches(axes)) continue;
    const RequestContext& waits = live->context;
    waiting.push_back({waits.who, waits.lease, live->uses, id, waits.session});
  }
  rights_.stop_asked({by.who, by.lease, axes, 0, by.session}, waiting);
}

void Motions::stop_asked(LiveMotion& live, const std::string& who) {
  live.life.stop(who);
  if (live.life.shown() == MotionState::stopping) show(live, MotionState::stopping);
}

std::vector<MotionId> Motions::stop_asked(AxisSet axes, const std::string& who) {
  std::vector<MotionId> stopped;
  for (const auto& [id, live] : live_) {
    if (!live->motion.axes.touches(axes)) continue;
    ++live->wake_ups;
    stopped.push_back(id);
    stop_asked(*live, who);
    live->changed.notify();
    if (live->jog) live->jog->changed.notify();
  }
  return stopped;
}

void Motions::line_lost(const std::string& why) {
  for (const auto& [id, live] : live_) {
    if (!live->life.has_turn()) continue;
    live->life.lose_line(why);
    // The newest line may have been its start, even without a reply.
    if (live->life.has_written() && guarded(Guard::moving_unknown)) store_.may_move_unseen();
    live->changed.notify();
  }
  gate_.withdraw([this](MotionId id) { return live_.contains(id); },
                 {.reason = Reason::not_sent,
                  .message = "the line to the controller was lost before the motion was sent: " + why,
                  .hint = "try again when the device is up"});
}

void Motions::expire_waiting() {
  gate_.expire([this](AxisSet axes) { return occupation_of(axes); });
}

// Returns text about the motions inside that have any of the axes; empty if there are none.
std::string Motions::occupation_of(AxisSet axes) const {
  std::string text;
  for (const auto& [id, live] : live_) {
    if (!gate_.axes_of(id).touches(axes)) continue;
    text += (text.empty() ? "" : ", ") + text_of(occupation_by(live->motion), tasks_.now());
  }
  return text;
}

void Motions::completion_seen(int axis, bool doubtful, bool deduced) {
  LiveMotionPtr owner;
  for (const auto& [id, live] : live_) {
    if (live->life.has_turn() && live->motion.axes.has(axis) && !live->life.unstarted()) owner = live;
  }
  store_.emit(CompletionSeen{axis, owner ? owner->motion.id : 0, deduced});
  if (!owner) return;
  owner->completed.add(axis);
  for (auto& result : owner->motion.results) {
    if (result.axis == axis) result.completion_seen = true;
  }
  owner->completions.push_back({axis, doubtful, tasks_.now()});
  if (owner->completed_by_all()) ++owner->wake_ups;
  if (owner->on_completion) owner->on_completion(axis);
  owner->changed.notify();
}

LiveMotionPtr Motions::find_live(MotionId id) const {
  const auto found = live_.find(id);
  return found == live_.end() ? nullptr : found->second;
}

std::optional<Motion> Motions::find(MotionId id) const {
  if (const auto live = find_live(id)) return live->motion;
  const auto found = std::ranges::find(ended_, id, &Motion::id);
  return found == ended_.end() ? std::nullopt : std::optional(*found);
}

std::vector<Motion> Motions::all() const {
  std::vector<Motion> all(ended_.begin(), ended_.end());
  for (const auto& [id, live] : live_) all.push_back(live->motion);
  return all;
}

AxisSet Motions::running() const {
  AxisSet axes;
  for (const auto& [id, live] : live_) {
    if (!live->life.unstarted()) axes = axes | live->motion.axes;
  }
  return axes;
}

AxisSet Motions::inside() const {
  AxisSet axes;
  for (const auto& [id, live] : live_) {
    if (live->life.has_turn()) axes = axes | live->motion.axes;
  }
  return axes;
}

AxisSet Motions::occupied() const {
  AxisSet axes = inside();
  for (const auto& [id, its] : restoring_) axes = axes | its;
  return axes;
}

bool Motions::anything_moves() const {
  const bool ours = std::ranges::any_of(live_, [](const auto& entry) { return !entry.second->life.unstarted(); });
  return ours ||
         std::ranges::any_of(store_.state().axes, [](const AxisState& axis) { return axis.busy.value_or(false); });
}

bool Motions::any_chain() const {
  return std::ranges::any_of(live_, [](const auto& entry) {
    const MotionKind kind = entry.second->motion.kind;
    return kind == MotionKind::path || kind == MotionKind::execute || entry.second->segments > 1;
  });
}

Positions places_of(const LiveMotion& live, const State& state) {
  Positions places = positions_of(state);
  for (const int other : (kAllAxes - live.motion.axes).list()) {
    places[static_cast<std::size_t>(other - 1)].reset();
  }
  return places;
}

Problem stopped_by(const LiveMotion& live) {
  return {.reason = Reason::stopped, .message = "stopped by " + live.life.stopped_by()};
}

}  // namespace axisgate::shrc203
