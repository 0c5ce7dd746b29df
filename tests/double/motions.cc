// Motions of a rotor, from their turn to their outcome.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tests/double/controller.h"

namespace axisgate::rotor {
namespace {

constexpr Duration kJogStopRepeat = std::chrono::seconds(1), kJogLeasePoll = std::chrono::milliseconds(50);
// Longest time until a stop is answered: a reading in progress and then the stop, each with a full time limit.
constexpr Duration kJogReaction = 2 * kReplyLimit;

Problem refused(std::int32_t code) {
  switch (static_cast<Refusal>(code)) {
    case Refusal::busy:
      return {
          .reason = Reason::axis_busy, .message = "the rotor moves already", .hint = "wait until it stands", .axis = 1};
    case Refusal::out_of_range:
      return {.reason = Reason::out_of_range, .message = "the rotor does not go that far", .axis = 1};
    case Refusal::unknown:
      break;
  }
  return {.reason = Reason::device_refused, .message = fmt::format("the rotor refused it with {}", code), .axis = 1};
}

Problem stopped_problem(const std::string& who) { return {.reason = Reason::stopped, .message = "stopped by " + who}; }

Opcode start_of(MotionKind kind) {
  return kind == MotionKind::home ? Opcode::home : kind == MotionKind::jog ? Opcode::jog : Opcode::move;
}

}  // namespace

void Controller::expire_waiting() {
  std::vector<MotionId> late;
  for (const auto& [id, live] : live_) {
    if (!live.has_turn && live.context.not_after <= now_) late.push_back(id);
  }
  for (const MotionId id : late) {
    end(id, MotionState::failed,
        Problem{.reason = Reason::deadline_passed, .message = "its turn did not come in the time allowed"});
  }
}

// Starts the next motion, if any. No motion gets its turn while a stop is in progress.
bool Controller::take_turn() {
  if (live_.empty() || !stops_.empty() || state_.link != LinkState::up) return false;
  auto& [id, live] = *live_.begin();
  if (live.has_turn) return false;
  const Use use{live.context.who, live.context.lease, kAxis, id};
  auto good = permission_.authorize(use, now_);
  if (good) good = check_epochs(live.context);
  if (!good) {
    end(id, MotionState::failed, good.error());
    return true;
  }
  live.has_turn = true;
  permission_.begin(use, stage::occupation_by(live.motion), now_);
  ask_status(
      Lane::motion, live.context.who, [this, id = id](const Answer& looked) { at_turn(id, looked); },
      live.context.not_after);
  return true;
}

void Controller::at_turn(MotionId id, const Answer& looked) {
  Live* live = find(id);
  if (live == nullptr) return;
  if (!looked.payload) return end(id, MotionState::failed, looked.problem);
  const auto payload = plan_start(*live);
  if (!payload) return end(id, MotionState::failed, payload.error());
  ask_start(*live, *payload, [this, id](const Answer& answer) { started(id, answer); });
}

void Controller::ask_start(Live& live, std::int32_t payload, std::function<void(const Answer&)> done) {
  wire_.ask({.opcode = start_of(live.motion.kind),
             .payload = payload,
             .lane = Lane::motion,
             .who = live.context.who,
             .not_after = live.motion.state == MotionState::queued ? live.context.not_after : TimePoint::max(),
             .motion = live.motion.id,
             .done = std::move(done)},
            now_);
}

Result<std::int64_t> Controller::plan_move(const MoveRequest& request) const {
  const Envelope limits = envelope(request.context);
  if (request.moves.empty()) return fail(Reason::invalid_request, "no axis was named", "name axis 1 and a distance");
  for (const AxisMove& one : request.moves) {
    if (const auto good = limits.check_axis(one.axis); !good) return tl::unexpected(good.error());
  }
  if (request.moves.size() > 1) return fail(Reason::invalid_request, "axis 1 is named twice");
  const AxisMove& one = request.moves[0];
  if (const auto good = limits.check_homed(1); !good) return tl::unexpected(good.error());
  if (one.profile) return cannot("moves at its own speed: no other can be set", "leave the speed out, or jog it");
  if (one.approach) return cannot("cannot approach its target from one side", "ask for two moves");
  const auto cap = limits.speed_cap(1);
  if (!cap) return tl::unexpected(cap.error());
  if (*cap)
    return fail_on(1, Reason::too_fast, "a rotor moves at its own speed, and this caller's is limited", "jog it");
  const auto amount = limits.pulses(1, one.distance);
  if (!amount) return tl::unexpected(amount.error());
  const std::int64_t target = *amount + (request.relative ? state_.axis(1).position_pulses.value_or(0) : 0);
  if (const auto good = limits.check_target(1, target); !good) return tl::unexpected(good.error());
  if (std::abs(target) > kCountMax) {
    return fail_on(1, Reason::out_of_range, fmt::format("a rotor counts to {} pulses either way", kCountMax));
  }
  return target;
}

// Returns the payload of the start command, based on the reading just taken.
Result<std::int32_t> Controller::plan_start(Live& live) const {
  AxisResult& result = live.motion.results[0];
  if (state_.axis(1).busy.value_or(true)) {
    return tl::unexpected(refused(static_cast<std::int32_t>(Refusal::busy)));
  }
  if (live.motion.kind == MotionKind::home) {
    result.target_pulses = 0;
    live.found_before = origin_found_;
    return 0;
  }
  if (live.move) {
    const auto target = plan_move(*live.move);
    if (!target) return tl::unexpected(target.error());
    result.target_pulses = *target;
    return static_cast<std::int32_t>(sign_ * *target);
  }
  Jog& jog = *live.jog;
  jog.fastest = jog.sent = jog.speed;
  const auto bound = stop_before_bound(live, jog.speed);
  if (bound && *bound <= now_) {
    return fail_on(1, Reason::outside_travel, "axis 1 is too near to its travel limit to jog further",
                   "move it there, or jog it more slowly");
  }
  return static_cast<std::int32_t>(sign_ * jog.direction * jog.speed);
}

void Controller::started(MotionId id, const Answer& answer) {
  Live* live = find(id);
  if (live == nullptr) return;
  if (!answer.written) return end(id, MotionState::failed, answer.problem);
  if (answer.payload.value_or(0) != 0) {
    const bool stopped = !live->stopped_by.empty();
    return end(id, stopped ? MotionState::stopped : MotionState::failed, refused(*answer.payload));
  }
  live->in_doubt = !answer.payload;
  ask_status(Lane::motion, live->context.who);
  if (answer.payload) mark_running(*live);
}

void Controller::mark_running(Live& live) {
  live.in_doubt = false;
  if (live.motion.state != MotionState::queued) return;
  live.motion.started = now_;
  live.motion.state = live.stopped_by.empty() ? MotionState::running : MotionState::stopping;
  emit(MotionChanged{live.motion});
  if (const auto tell = std::exchange(live.on_started, {})) tell(live.motion);
}

void Controller::end(MotionId id, MotionState outcome, std::optional<Problem> problem) {
  auto node = live_.extract(id);
  if (node.empty()) return;
  Live& live = node.mapped();
  const bool never_started = live.motion.state == MotionState::queued;
  live.motion.state = outcome;
  live.motion.ended = now_;
  live.motion.problem = std::move(problem);
  live.motion.results[0].command_pulses = state_.axis(1).position_pulses;
  wire_.withdraw(id);
  ended_.push_back(live.motion);
  if (ended_.size() > kMotionsKept) ended_.pop_front();
  emit(MotionChanged{live.motion});
  if (live.has_turn) permission_.end(id, now_);
  const auto tell = std::exchange(live.on_started, {});
  if (!tell) return;
  const bool refusal = never_started && live.motion.problem && outcome != MotionState::unknown;
  tell(refusal ? Result<Motion>(tl::unexpected(*live.motion.problem)) : Result<Motion>(live.motion));
}

// Finds out from the newest reading whether the motion has ended. The rotor is busy as soon as it accepts a start, so a
// rotor that is not busy has ended its motion.
void Controller::judge() {
  if (live_.empty()) return;
  Live& live = live_.begin()->second;
  if (!live.wrote || (live.motion.state == MotionState::queued && !live.in_doubt)) return;
  if (*state_.axis(1).busy) return mark_running(live);
  judge_standing(live);
}

void Controller::judge_standing(const Live& live) {
  const MotionId id = live.motion.id;
  const bool by_move = live.move && state_.axis(1).position_pulses == live.motion.results[0].target_pulses;
  // If the start was not answered, an origin that was found before proves nothing.
  const bool by_home = live.motion.kind == MotionKind::home && origin_found_ && !(live.in_doubt && live.found_before);
  if (by_home) {
    state_.axis(1).homed = true;
    ++state_.axis(1).homings;
    emit(StateChanged{});
  }
  if (by_move || by_home) return end(id, MotionState::succeeded, {});
  if (live.in_doubt) {
    const bool jogs = live.jog.has_value();
    end(id, MotionState::unknown,
        Problem{.reason = Reason::outcome_unknown,
                .message = "the answer to the start was lost, and nothing tells whether it ran",
                .hint = "look at the position; the motion was not sent again"});
    if (jogs) stop_rotor(kAxis, false, "the gateway: a jog that was not answered", [](const StopReport&) {});
    return;
  }
  if (live.jog && live.jog->ended) {
    const auto why = live.jog->why;
    return end(id, why ? MotionState::stopped : MotionState::succeeded, why);
  }
  if (!live.stopped_by.empty()) return end(id, MotionState::stopped, stopped_problem(live.stopped_by));
  end(id, MotionState::failed,
      Problem{
          .reason = Reason::target_not_reached,
          .message = live.jog ? "it stands, although nobody here has stopped it" : "it stands, but not at its target",
          .hint = "look at the rotor",
          .axis = 1});
}

void Controller::keep_jogs() {
  std::vector<MotionId> jogs;
  for (const auto& [id, live] : live_) {
    if (live.jog) jogs.push_back(id);
  }
  for (const MotionId id : jogs) {
    if (Live* live = find(id)) keep_jog(*live);
  }
}

// Ends the jog if necessary, and repeats the stop if one stop was not enough.
void Controller::keep_jog(Live& live) {
  Jog& jog = *live.jog;
  if (!jog.ended && !live.stopped_by.empty()) {
    jog = {.ended = true, .why = stopped_problem(live.stopped_by), .stop_at = now_ + kJogStopRepeat};
  } else if (auto why = jog.ended ? std::nullopt : must_end(live)) {
    jog.ended = true;
    jog.why = std::move(why);
    jog.stop_at = now_;
  }
  if (!jog.ended) return keep_running(live);
  if (!live.wrote) {
    const Problem by_caller{.reason = Reason::stopped, .message = "the jog was ended before it was sent"};
    return end(live.motion.id, MotionState::stopped, jog.why.value_or(by_caller));
  }
  if (*jog.stop_at > now_) return;
  jog.stop_at = now_ + kJogStopRepeat;
  stop_rotor(kAxis, false, jog.why ? "the gateway: " + jog.why->message : live.context.who, [](const StopReport&) {});
}

void Controller::keep_running(Live& live) {
  Jog& jog = *live.jog;
  jog.stop_at = jog.renewed + kJogSilence;
  if (live.context.lease != 0) jog.stop_at = std::min(*jog.stop_at, now_ + kJogLeasePoll);
  if (live.motion.state != MotionState::running) return;
  if (jog.speed != jog.sent) {
    jog.sent = jog.speed;
    jog.fastest = std::max(jog.fastest, jog.speed);
    ask_start(live, static_cast<std::int32_t>(sign_ * jog.direction * jog.speed), [](const Answer&) {});
  }
  const auto bound = stop_before_bound(live, jog.fastest);
  if (bound) jog.stop_at = std::min(*jog.stop_at, *bound);
}

std::optional<Problem> Controller::must_end(const Live& live) {
  if (now_ - live.jog->renewed >= kJogSilence) {
    return Problem{.reason = Reason::stopped,
                   .message = "the caller of the jog was silent for 500 ms",
                   .hint = "renew it several times in that time"};
  }
  if (live.context.lease != 0) {
    const auto good = permission_.authorize({live.context.who, live.context.lease, kAxis, 0}, now_);
    if (!good) return good.error();
  }
  if (live.motion.state != MotionState::running) return {};
  const auto bound = stop_before_bound(live, std::max(live.jog->fastest, live.jog->speed));
  if (!bound || *bound > now_) return {};
  return Problem{.reason = Reason::outside_travel,
                 .message = "axis 1 came near its travel limit",
                 .hint = "move it the remaining displacement, or jog it back",
                 .axis = 1};
}

// Returns the latest time at which a stop must be requested, based on the newest reading; nullopt if the position or
// the bound is unknown.
std::optional<TimePoint> Controller::stop_before_bound(const Live& live, std::int64_t speed) const {
  const auto position = state_.axis(1).position_pulses;
  const auto bound = envelope(live.context).bound(1, live.jog->direction);
  if (!position || !bound) return {};
  const std::int64_t end = std::clamp(*bound, -kCountMax, kCountMax);
  const double left = static_cast<double>(live.jog->direction * (end - *position)) / static_cast<double>(speed);
  const double wait = std::min(left - std::chrono::duration<double>(kJogReaction).count(), 3600.0);
  return state_.read + Duration(static_cast<std::int64_t>(wait * 1e9));
}

}  // namespace axisgate::rotor
