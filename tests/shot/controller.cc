#include "tests/shot/controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::shot2 {
namespace {

constexpr Duration kStartLimit = std::chrono::seconds(5);

}  // namespace

Controller::Controller(const Model& model, shot::Profile profile, ByteLink& link, EventSink& events,
                       Permission& permission)
    : model_(model),
      profile_(std::move(profile)),
      events_(events),
      permission_(permission),
      line_(model_, profile_, link, tasks_.executor(), *this) {
  tasks_.spawn(poll());
}

template <class Call>
void Controller::at(TimePoint now, Call call) {
  tasks_.now_is(now);
  call();
  tasks_.executor().run();
}

void Controller::link_up(TimePoint now) {
  at(now, [&] { line_.link_up(now); });
}

void Controller::link_down(TimePoint now, std::string_view why) {
  at(now, [&] { line_.link_down(now, why); });
}

void Controller::receive(std::string_view bytes, TimePoint now) {
  at(now, [&] { line_.receive(bytes, now); });
}

void Controller::advance(TimePoint now) {
  at(now, [&] {
    line_.advance(now);
    carry_out_orders();
    tasks_.executor().advance(now);
  });
}

std::optional<TimePoint> Controller::next_deadline() const {
  std::optional<TimePoint> next;
  for (const auto& due : {line_.next_deadline(tasks_.now()), executor_.next_deadline(), permission_.next_deadline()}) {
    if (due && (!next || *due < *next)) next = due;
  }
  return next;
}

tl::unexpected<Problem> Controller::cannot() const {
  return fail(Reason::not_allowed, fmt::format("device {}: it moves, homes and stops, and no more", profile_.name),
              "ask for moves");
}

Result<void> Controller::check_up() const {
  if (ending_) return tl::unexpected(*ending_);
  if (state_.link == LinkState::up || state_.link == LinkState::doubtful) return {};
  return fail(Reason::link_down, "the device is not up: " + state_.link_problem, "try again when it is up");
}

Result<void> Controller::check_use(const RequestContext& context, AxisSet axes) {
  return permission_.authorize({context.who, context.lease, axes, 0}, tasks_.now());
}

Result<Controller::Targets> Controller::plan(const MoveRequest& request) const {
  const stage::Envelope envelope(profile_, state_, request.context.who, request.context.role);
  Targets targets;
  for (const AxisMove& move : request.moves) {
    auto good = envelope.check_axis(move.axis);
    if (good) good = envelope.check_homed(move.axis);
    if (!good) return tl::unexpected(good.error());
    if (move.profile || move.approach) return cannot();
    const auto amount = envelope.pulses(move.axis, move.distance);
    if (!amount) return tl::unexpected(amount.error());
    const std::optional<std::int64_t> from = request.relative ? state_.axis(move.axis).position_pulses : 0;
    if (!from) return envelope.position_unknown(move.axis);
    if (good = envelope.check_target(move.axis, *from + *amount); !good) return tl::unexpected(good.error());
    if (!targets.emplace(move.axis, *from + *amount).second) {
      return fail(Reason::invalid_request, fmt::format("axis {} is named twice", move.axis));
    }
  }
  if (targets.empty()) return fail(Reason::invalid_request, "no axis was named", "name an axis and a target");
  return targets;
}

Result<void> Controller::check(const MoveRequest& request) const {
  if (const auto up = check_up(); !up) return up;
  const auto targets = plan(request);
  return targets ? Result<void>() : tl::unexpected(targets.error());
}
Result<void> Controller::check(const PathRequest&) const { return cannot(); }
Result<void> Controller::check(const ScanRequest&) const { return cannot(); }
Result<void> Controller::check(const GoToPositionRequest&) const { return cannot(); }

void Controller::begin(MotionKind kind, AxisSet axes, std::optional<Targets> targets, RequestContext context,
                       OnStarted started) {
  if (const auto good = check_use(context, axes); !good) return started(tl::unexpected(good.error()));
  if (context.not_after == TimePoint{}) context.not_after = tasks_.now() + kStartLimit;
  const auto live = std::make_shared<Live>();
  live->motion.id = ++last_motion_;
  live->motion.kind = kind;
  live->motion.axes = axes;
  for (const int axis : axes.list()) {
    live->motion.results.push_back({axis, targets ? targets->at(axis) : 0, {}, false});
  }
  live->motion.who = context.who;
  live->motion.request_id = context.request_id;
  live->motion.created = tasks_.now();
  live->targets = std::move(targets);
  live->context = std::move(context);
  live->on_started = std::move(started);
  live_.push_back(live);
  emit(MotionChanged{live->motion});
  tasks_.spawn(run(live));
}

void Controller::move(MoveRequest request, TimePoint now, OnStarted started) {
  at(now, [&] {
    if (const auto good = check(request); !good) return started(tl::unexpected(good.error()));
    auto targets = plan(request);
    AxisSet axes;
    for (const auto& [axis, target] : *targets) axes.add(axis);
    begin(MotionKind::move, axes, *std::move(targets), std::move(request.context), std::move(started));
  });
}

void Controller::home(HomeRequest request, TimePoint now, OnStarted started) {
  at(now, [&] {
    const AxisSet axes = request.axes.empty() ? state_.controllable() : request.axes;
    Result<void> good = check_up();
    const stage::Envelope envelope(profile_, state_, request.context.who, request.context.role);
    for (const int axis : axes.list()) {
      if (good) good = envelope.check_axis(axis);
    }
    if (!good) return started(tl::unexpected(good.error()));
    begin(MotionKind::home, axes, {}, std::move(request.context), std::move(started));
  });
}

void Controller::return_to_origin(HomeRequest request, TimePoint now, OnStarted started) {
  MoveRequest back{{}, false, std::move(request.context)};
  for (const int axis : (request.axes.empty() ? state_.controllable() : request.axes).list()) {
    back.moves.push_back({.axis = axis, .distance = pulses(0), .profile = {}});
  }
  move(std::move(back), now, std::move(started));
}

void Controller::run_path(PathRequest, TimePoint, OnStarted started) { started(cannot()); }
void Controller::scan(ScanRequest, TimePoint, OnStarted started) { started(cannot()); }
void Controller::go_to_position(GoToPositionRequest, TimePoint, OnStarted started) { started(cannot()); }

MotionId Controller::jog(JogRequest, TimePoint, OnStarted started) {
  started(cannot());
  return 0;
}
Result<void> Controller::renew_jog(MotionId, const std::vector<JogRequest::Axis>&, TimePoint) { return cannot(); }
void Controller::end_jog(MotionId, std::optional<Problem>, TimePoint) {}

void Controller::execute(ExecuteRequest, TimePoint, OnExecute event) {
  ExecuteEvent end;
  end.kind = ExecuteEvent::Kind::ended;
  end.problem = cannot().value();
  event(end);
}

void Controller::refresh(Duration max_age, const RequestContext& context, TimePoint now, OnState done) {
  at(now, [&] {
    if (const auto up = check_up(); !up) return done(tl::unexpected(up.error()));
    if (now - state_.read <= max_age) return done(state_);
    tasks_.spawn(refresh_for(context, std::move(done)));
  });
}

void Controller::stop(AxisSet axes, const RequestContext& context, TimePoint now, OnStopped done) {
  at(now, [&] {
    const AxisSet named = axes.empty() ? model_.axes() : axes;
    permission_.stop_asked({context.who, context.lease, named, 0}, {}, now);
    stop_axes(named, context.who, std::move(done));
  });
}

// Stops both axes like stop(): nothing is latched, since it has no errors to clear.
void Controller::emergency_stop(const RequestContext& context, TimePoint now, OnStopped done) {
  stop({}, context, now, std::move(done));
}

void Controller::clear_errors(AxisSet, const RequestContext&, TimePoint, OnDone done) { done({}); }

std::vector<Motion> Controller::motions() const {
  std::vector<Motion> all(ended_.begin(), ended_.end());
  for (const LivePtr& live : live_) all.push_back(live->motion);
  return all;
}

std::optional<Motion> Controller::find_motion(MotionId id) const {
  const std::vector<Motion> all = motions();
  const auto found = std::ranges::find(all, id, &Motion::id);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

void Controller::cancel_motion(MotionId id, const RequestContext& context, TimePoint now, OnDone done) {
  const LivePtr live = find(id);
  if (!live) return done(fail(Reason::not_found, fmt::format("motion {} has ended", id)));
  stop(live->motion.axes, context, now, [done = std::move(done)](const StopReport&) { done({}); });
}

void Controller::wind_down(TimePoint now, OnWoundDown done) {
  at(now, [&] {
    ending_ = Problem{.reason = Reason::not_sent, .message = "the gateway ends"};
    if (!live_.empty()) stop_axes(model_.axes(), "the gateway (it ends)", [](const StopReport&) {});
    tasks_.spawn(end_all(std::move(done)));
  });
}

}  // namespace axisgate::shot2
