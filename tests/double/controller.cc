#include "tests/double/controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/stage/own_questions.h"

namespace axisgate::rotor {
namespace {

constexpr Duration kMotionStartLimit = std::chrono::seconds(5), kQuestionLimit = std::chrono::seconds(5);

std::optional<TimePoint> sooner(std::optional<TimePoint> a, std::optional<TimePoint> b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

}  // namespace

Controller::Controller(Profile profile, bool reversed, ByteLink& link, EventSink& events, Permission& permission)
    : profile_(std::move(profile)),
      sign_(reversed ? -1 : 1),
      events_(events),
      permission_(permission),
      wire_(link, *this) {}

// Repeats until nothing is left to do, because a callback may have made new requests.
void Controller::settle() {
  if (std::exchange(settling_, true)) return;
  while (wire_.pump(now_) || take_turn() || wind_on()) {
  }
  settling_ = false;
}

void Controller::link_up(TimePoint now) {
  at(now, [&] { wire_.link_up(now); });
}

void Controller::link_down(TimePoint now, std::string_view why) {
  at(now, [&] { wire_.lose(std::string(why), now); });
}

void Controller::receive(std::string_view bytes, TimePoint now) {
  at(now, [&] { wire_.receive(bytes, now); });
}

void Controller::advance(TimePoint now) {
  at(now, [&] {
    wire_.advance(now);
    expire_waiting();
    carry_out_orders();
    keep_jogs();
    look_after_stops();
    if (const auto poll = poll_at(); poll && *poll <= now) ask_status(Lane::poll, kGateway);
  });
}

std::optional<TimePoint> Controller::next_deadline() const {
  auto next = sooner(sooner(wire_.next_deadline(), permission_.next_deadline()), poll_at());
  for (const auto& [id, live] : live_) {
    if (!live.has_turn && live.context.not_after != TimePoint::max()) next = sooner(next, live.context.not_after);
    if (live.jog && live.jog->stop_at) next = sooner(next, live.jog->stop_at);
  }
  for (const auto& job : stops_) next = sooner(next, job->stands_by);
  if (on_wound_down_ && now_ < ending_limit_) next = sooner(next, ending_limit_);
  return next;
}

tl::unexpected<Problem> Controller::cannot(std::string_view why, std::string hint) const {
  return fail(Reason::not_allowed, fmt::format("device {}: a rotor {}", profile_.name, why), std::move(hint));
}

Result<void> Controller::check_epochs(const RequestContext& context) const {
  const auto passed = [](std::uint64_t meant, std::uint64_t present) { return meant != 0 && meant != present; };
  if (!passed(context.device_epoch, state_.device_epoch) && !passed(context.frame_epoch, state_.frame_epoch)) return {};
  return fail(Reason::epoch_passed, "the rotor may have restarted since the epoch that the request is of",
              "look where it stands, and take the epoch from Device");
}

Result<void> Controller::allowed(const RequestContext& context, AxisSet axes) {
  if (const auto good = check_epochs(context); !good) return good;
  return permission_.authorize({context.who, context.lease, axes, 0}, now_);
}

Result<void> Controller::check_up() const {
  if (ending_) return tl::unexpected(*ending_);
  if (state_.link == LinkState::up) return {};
  return fail(Reason::link_down, "the device is not up: " + state_.link_problem, "try again when it is up");
}

Result<void> Controller::check_home(const HomeRequest& request) const {
  if (const auto up = check_up(); !up) return up;
  if (kAxis.contains(request.axes)) return {};
  return fail(Reason::unknown_axis, fmt::format("{}: a rotor has axis 1 only", to_string(request.axes)));
}

Result<std::int64_t> Controller::jog_speed(const std::optional<Quantity>& asked, const RequestContext& context) const {
  const Envelope limits = envelope(context);
  if (asked) return limits.speed(1, *asked);
  const auto cap = limits.speed_cap(1);
  if (!cap) return tl::unexpected(cap.error());
  return std::min(kJogSpeed, cap->value_or(kJogSpeed));
}

Controller::Live* Controller::find(MotionId id) {
  const auto found = live_.find(id);
  return found == live_.end() ? nullptr : &found->second;
}

// Returns null if the caller may not use the axis, or too many motions wait; `started` has then been called with the
// problem.
Controller::Live* Controller::create(MotionKind kind, const RequestContext& context, OnStarted& started) {
  auto good = allowed(context, kAxis);
  if (good && live_.size() >= kWaitingMax) {
    good = fail(Reason::queue_full, fmt::format("{} motions wait already", live_.size()), "try again later");
  }
  if (!good) {
    started(tl::unexpected(good.error()));
    return nullptr;
  }
  Live live;
  live.motion.id = ++last_motion_;
  live.motion.kind = kind;
  live.motion.axes = kAxis;
  live.motion.results = {{1, {}, {}, false}};
  live.motion.who = context.who;
  live.motion.request_id = context.request_id;
  live.motion.created = now_;
  live.context = context;
  if (context.not_after == TimePoint{}) live.context.not_after = now_ + kMotionStartLimit;
  live.on_started = std::move(started);
  emit(MotionChanged{live.motion});
  return &live_.emplace(last_motion_, std::move(live)).first->second;
}

void Controller::refresh(Duration max_age, const RequestContext& context, TimePoint now, OnState done) {
  at(now, [&] {
    if (const auto up = check_up(); !up) return done(tl::unexpected(up.error()));
    if (state_.read != TimePoint{} && now - state_.read <= max_age) return done(state_);
    const TimePoint limit = context.not_after == TimePoint{} ? now + kQuestionLimit : context.not_after;
    const auto then = [this, done](const Answer& answer) {
      done(answer.payload ? Result<State>(state_) : tl::unexpected(*answer.problem));
    };
    ask_status(Lane::question, context.who, then, limit);
  });
}

void Controller::move(MoveRequest request, TimePoint now, OnStarted started) {
  at(now, [&] {
    if (const auto good = check(request); !good) return started(tl::unexpected(good.error()));
    if (Live* live = create(MotionKind::move, request.context, started)) live->move = std::move(request);
  });
}

void Controller::home(HomeRequest request, TimePoint now, OnStarted started) {
  at(now, [&] {
    if (const auto good = check_home(request); !good) return started(tl::unexpected(good.error()));
    (void)create(MotionKind::home, request.context, started);
  });
}

void Controller::return_to_origin(HomeRequest request, TimePoint now, OnStarted started) {
  at(now, [&] {
    MoveRequest back{{AxisMove{.axis = 1, .distance = pulses(0), .profile = {}}}, false, request.context};
    auto good = check_home(request);
    if (good) good = check(back);
    if (!good) return started(tl::unexpected(good.error()));
    Live* live = create(MotionKind::return_to_origin, request.context, started);
    if (live != nullptr) live->move = std::move(back);
  });
}

MotionId Controller::jog(JogRequest request, TimePoint now, OnStarted started) {
  MotionId id = 0;
  at(now, [&] {
    auto good = check_up();
    if (good && request.axes.empty()) good = fail(Reason::invalid_request, "no axis was named", "name axis 1");
    for (const auto& one : request.axes) {
      if (good) good = envelope(request.context).check_axis(one.axis);
    }
    if (good && request.axes.size() > 1) good = fail(Reason::invalid_request, "axis 1 is named twice");
    if (good) good = envelope(request.context).check_homed(1);
    if (!good) return started(tl::unexpected(good.error()));
    const auto speed = jog_speed(request.axes[0].speed, request.context);
    if (!speed) return started(tl::unexpected(speed.error()));
    Live* live = create(MotionKind::jog, request.context, started);
    if (live == nullptr) return;
    id = live->motion.id;
    live->jog = Jog{.renewed = now,
                    .direction = request.axes[0].direction < 0 ? -1 : 1,
                    .speed = *speed,
                    .why = {},
                    .stop_at = now + kJogSilence};
  });
  return id;
}

Result<void> Controller::renew_jog(MotionId id, const std::vector<JogRequest::Axis>& speeds, TimePoint now) {
  Result<void> renewed;
  at(now, [&] {
    Live* live = find(id);
    if (live == nullptr || !live->jog) {
      renewed = fail(Reason::not_found, fmt::format("the jog {} has ended", id), "see its outcome: GetMotion");
      return;
    }
    for (const auto& one : speeds) {
      if (one.axis != 1 || !one.speed) {
        renewed = fail(Reason::unknown_axis, fmt::format("axis {} is not of this jog, or has no speed", one.axis));
        return;
      }
      const auto speed = jog_speed(one.speed, live->context);
      if (!speed) {
        renewed = tl::unexpected(speed.error());
        return;
      }
      live->jog->speed = *speed;
    }
    live->jog->renewed = now;
    keep_jogs();
  });
  return renewed;
}

void Controller::end_jog(MotionId id, std::optional<Problem> why, TimePoint now) {
  at(now, [&] {
    Live* live = find(id);
    if (live == nullptr || !live->jog || live->jog->ended || !live->stopped_by.empty()) return;
    live->jog->ended = true;
    live->jog->why = std::move(why);
    live->jog->stop_at = now;
    keep_jogs();
  });
}

Result<void> Controller::check_use(const RequestContext& context, AxisSet axes) { return allowed(context, axes); }

Result<void> Controller::check(const MoveRequest& request) const {
  if (const auto up = check_up(); !up) return up;
  const auto target = plan_move(request);
  return target ? Result<void>() : tl::unexpected(target.error());
}

Result<void> Controller::check(const PathRequest&) const {
  return cannot("has no look-ahead: paths are not possible", "ask for its targets one by one, as moves");
}

Result<void> Controller::check(const ScanRequest&) const {
  return cannot("has no trigger: scans are not possible", "jog it, and read its position meanwhile");
}

Result<void> Controller::check(const GoToPositionRequest&) const {
  return cannot("keeps no positions", "ask for a move to the place itself");
}

void Controller::run_path(PathRequest request, TimePoint, OnStarted started) {
  started(tl::unexpected(check(request).error()));
}

void Controller::scan(ScanRequest request, TimePoint, OnStarted started) {
  started(tl::unexpected(check(request).error()));
}

void Controller::go_to_position(GoToPositionRequest request, TimePoint, OnStarted started) {
  started(tl::unexpected(check(request).error()));
}

void Controller::clear_errors(AxisSet, const RequestContext&, TimePoint, OnDone done) {
  done(cannot("keeps no errors: there is nothing to clear", "see its link and its position"));
}

void Controller::execute(ExecuteRequest, TimePoint, OnExecute event) {
  ExecuteEvent ended;
  ended.kind = ExecuteEvent::Kind::ended;
  ended.problem = cannot("takes no lines of its callers'", "ask for moves, jogs and stops").value();
  event(ended);
}

std::vector<Motion> Controller::motions() const {
  std::vector<Motion> all(ended_.begin(), ended_.end());
  for (const auto& [id, live] : live_) all.push_back(live.motion);
  return all;
}

std::optional<Motion> Controller::find_motion(MotionId id) const {
  if (const auto live = live_.find(id); live != live_.end()) return live->second.motion;
  const auto ended = std::ranges::find(ended_, id, &Motion::id);
  return ended == ended_.end() ? std::nullopt : std::optional(*ended);
}

std::size_t Controller::queued(Lane lane) const {
  const auto waits = [](const auto& entry) { return !entry.second.has_turn; };
  const auto waiting = lane == Lane::motion ? std::ranges::count_if(live_, waits) : 0;
  return wire_.queued(lane) + static_cast<std::size_t>(waiting);
}

}  // namespace axisgate::rotor
