#include "device/shrc203/controller.h"

#include <fmt/format.h>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

Controller::Impl::Impl(Profile profile, ByteLink& link, EventSink& events, Permission& permission)
    : profile_(std::move(profile)),
      events_(events),
      permission_(permission),
      line_(profile_, link, executor_, *this),
      gate_(executor_, profile_.busy_scope),
      wake_poll_(executor_),
      tick_(executor_) {
  executor_.spawn(poll());
}

Controller::Impl::~Impl() = default;

void Controller::Impl::settle() { executor_.run(); }

std::optional<TimePoint> Controller::Impl::next_deadline() const {
  std::optional<TimePoint> next;
  for (const auto& at :
       {line_.next_deadline(now_), executor_.next_deadline(), gate_.next_deadline(), permission_.next_deadline()}) {
    if (at && (!next || *at < *next)) next = at;
  }
  return next;
}

void Controller::Impl::line_opened(TimePoint) {
  show_link();
  emit(LinkChanged{LinkState::connecting, "the line is open"});
}

void Controller::Impl::line_trusted(TimePoint) {
  show_link();
  note_link_problem(LinkTrouble::none, "");
  emit(LinkChanged{LinkState::up, "", state_.controllable()});
}

void Controller::Impl::same_controller(TimePoint) { show_link(); }

void Controller::Impl::line_connected(const Identity& identity, TimePoint) {
  ++connection_;
  stop_runaways();
  executor_.spawn(handshake(identity, connection_));
}

// Again and again, until everything was seen to stand.
void Controller::Impl::stop_runaways() {
  if (runaways_.empty() || !guarded(Guard::runaways_stopped)) return;
  stop(runaways_, false, {.who = "the gateway: a jog ran on while the line was lost"}, [](const StopReport&) {});
}

void Controller::Impl::line_lost(const std::string& why, TimePoint) {
  ++connection_;
  settled_ = false;
  if (guarded(Guard::registers_unknown_after_connect)) registers_.forget();
  const bool news = state_.link != LinkState::down || state_.link_problem != why;
  show_link();
  note_link_problem(LinkTrouble::line, why);
  state_.outputs.reset();
  state_.trigger.reset();
  for (auto& axis : state_.axes) {
    // It may be nobody's here that moves.
    state_.moving_unknown = state_.moving_unknown || (axis.busy.value_or(false) && guarded(Guard::moving_unknown));
    axis.position_pulses.reset();
    axis.busy.reset();
  }
  for (const auto& [id, live] : live_) {
    if (!live->inside_gate) continue;
    live->line_lost = true;
    live->line_problem = why;
    if (live->jog && live->wrote) runaways_ = runaways_ | live->motion.axes;
    // What it wrote last may have been its start, though no answer has come.
    state_.moving_unknown = state_.moving_unknown || (live->wrote && guarded(Guard::moving_unknown));
    live->news.notify();
  }
  gate_.withdraw([this](MotionId id) { return live_.contains(id); },
                 {.reason = Reason::not_sent,
                  .message = "the line to the controller was lost before the motion was sent: " + why,
                  .hint = "try again when the device is up"});
  if (!news) return;
  emit(LinkChanged{LinkState::down, why});
  publish_state();
}

void Controller::Impl::barrier_entered(const std::string& why, TimePoint) {
  settled_ = false;
  show_link();
  emit(BarrierEntered{why});
}

void Controller::Impl::barrier_passed(const Identity& identity, TimePoint) {
  show_link();
  if (!line_.state().trusted()) return;
  const bool same = identity.serial_number == state_.serial_number && identity.model == state_.model;
  if (!same && guarded(Guard::serial_number_after_barrier)) {
    line_.give_up(fmt::format("another controller answers: {} {}", escaped(identity.model), identity.serial_number),
                  now_);
    return;
  }
}

void Controller::Impl::restart_suspected(TimePoint) {
  settled_ = false;
  show_link();
  executor_.spawn(look_for_restart(connection_));
}

void Controller::Impl::completion_seen(int axis, bool doubtful, TimePoint now) {
  note_completion(axis, doubtful, false, now);
}

void Controller::Impl::note_completion(int axis, bool doubtful, bool deduced, TimePoint now) {
  line_.completions().arrived(axis);
  LiveMotionPtr owner;
  for (const auto& [id, live] : live_) {
    if (live->inside_gate && live->motion.axes.has(axis) && live->motion.state != MotionState::queued) owner = live;
  }
  emit(CompletionSeen{axis, owner ? owner->motion.id : 0, deduced});
  if (!owner) return;
  owner->completed.add(axis);
  for (auto& result : owner->motion.results) {
    if (result.axis == axis) result.completion_seen = true;
  }
  owner->completions.push_back({axis, doubtful, now});
  owner->woken = owner->woken || owner->completed == owner->motion.axes;
  if (owner->on_completion) owner->on_completion(axis);
  owner->news.notify();
}

void Controller::Impl::line_event(const Event& event, TimePoint) {
  if (std::holds_alternative<IllegalTransition>(event)) {
    // The stop outlives the line that is about to be given up, and goes first on the next one.
    stop(AxisSet::all(), false, {.who = kGateway}, [](const StopReport&) {});
  }
  const auto* notice = std::get_if<ProgramNotice>(&event);
  if (!notice || !guarded(Guard::notices_bounded)) return emit(event);
  NoticeCount& count = notices_[notice->kind];
  ++count.untold;
  if (std::exchange(count.telling, true)) return;
  executor_.spawn(tell_notices(notice->kind));
}

// The first at once, and then those that came meanwhile as one.
Task<void> Controller::Impl::tell_notices(ProgramNotice::Kind kind) {
  NoticeCount& count = notices_[kind];
  while (count.untold > 0) {
    emit(ProgramNotice{kind, std::exchange(count.untold, 0)});
    auto pause = tick_.wait_until(now_ + kProgramNoticePause);
    co_await pause;
  }
  count.telling = false;
}

Result<void> Controller::Impl::check_epochs(const RequestContext& context) const {
  const auto passed = [](std::uint64_t meant, std::uint64_t present) { return meant != 0 && meant != present; };
  if (passed(context.device_epoch, state_.device_epoch) && guarded(Guard::passed_epochs_refused)) {
    return fail(Reason::epoch_passed,
                fmt::format("the request is of device epoch {}, and this is {}: the controller may have restarted "
                            "meanwhile, and places may be others",
                            context.device_epoch, state_.device_epoch),
                "look where the axes are, find their origin where it matters, and take the epoch from Device");
  }
  if (passed(context.frame_epoch, state_.frame_epoch) && guarded(Guard::passed_frames_refused)) {
    return fail(Reason::epoch_passed,
                fmt::format("the request is of frame epoch {}, and this is {}: somebody has set coordinates anew (R:, "
                            "RC:, PSET:), or the controller has restarted",
                            context.frame_epoch, state_.frame_epoch),
                "look where the axes are, reckon the targets anew, and take the epoch from Device");
  }
  return {};
}

// The travel limits count from the origin that the axis has found: coordinates set since are from elsewhere.
void Controller::Impl::frame_shifted(AxisSet axes) {
  ++state_.frame_epoch;
  for (const int axis : axes.list()) state_.axis(axis).homed = false;
  settled_ = false;
}

Result<void> Controller::Impl::may_use(const RequestContext& context, AxisSet axes) {
  if (const auto good = check_epochs(context); !good) return good;
  return permission_.may_use({context.who, context.lease, axes, 0}, now_);
}

// The right may have ended since the exchange was queued: this is the last look before the bytes go out.
std::optional<Problem> Controller::Impl::may_write(const ExchangeRequest& request, TimePoint now) {
  const auto found = live_.find(request.motion);
  // What was given up at the gateway's end sends nothing more.
  if (found == live_.end() && ending_) return ending_;
  const bool alone = request.motion == 0 && !request.uses.empty();
  if ((found == live_.end() && !alone) || !guarded(Guard::lease_asked_as_bytes_go)) return {};
  Use use{request.caller, request.lease, request.uses, 0};
  if (!alone) {
    const LiveMotion& live = *found->second;
    use = {live.context.who, live.context.lease, live.uses, live.motion.id};
  }
  const auto allowed = permission_.may_use(use, now);
  if (allowed) return {};
  return allowed.error();
}

void Controller::Impl::carry_out_orders() {
  const Orders orders = permission_.advance(now_);
  for (const StopOrder& order : orders.stops) {
    const RequestContext gateway{.who = "the gateway on behalf of " + order.who};
    stop(order.axes, false, gateway, [this, id = order.id](const StopReport&) { permission_.stopped(id, now_); });
  }
  for (const EndedLease& lease : orders.restoring) executor_.spawn(restore_settings_of(lease));
}

Controller::Controller(Profile profile, ByteLink& link, EventSink& events)
    : Controller(std::move(profile), link, events, everybody_may()) {}
Controller::Controller(Profile profile, ByteLink& link, EventSink& events, Permission& permission)
    : impl_(std::make_unique<Impl>(std::move(profile), link, events, permission)) {}
Controller::~Controller() = default;

void Controller::link_up(TimePoint now) {
  impl_->at(now, [&] { impl_->line_.link_up(now); });
}

void Controller::link_down(TimePoint now, std::string_view why) {
  impl_->at(now, [&] { impl_->line_.link_down(now, why); });
}

void Controller::receive(std::string_view bytes, TimePoint now) {
  impl_->at(now, [&] { impl_->line_.receive(bytes, now); });
}

void Controller::advance(TimePoint now) {
  impl_->at(now, [&] {
    impl_->line_.advance(now);
    impl_->gate_.expire(now);
    impl_->carry_out_orders();
    impl_->executor_.advance(now);
  });
}

std::optional<TimePoint> Controller::next_deadline() const { return impl_->next_deadline(); }
const Profile& Controller::profile() const { return impl_->profile_; }
const State& Controller::state() const { return impl_->state_; }

void Controller::refresh(Duration max_age, const RequestContext& context, TimePoint now, OnState done) {
  if (impl_->ending_) return done(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->executor_.spawn(impl_->refresh(max_age, context, std::move(done))); });
}

void Controller::move(MoveRequest request, TimePoint now, OnStarted started) {
  if (impl_->ending_) return started(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->move(std::move(request), std::move(started)); });
}

void Controller::scan(ScanRequest request, TimePoint now, OnStarted started) {
  if (impl_->ending_) return started(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->scan(std::move(request), std::move(started)); });
}

void Controller::home(HomeRequest request, TimePoint now, OnStarted started) {
  if (impl_->ending_) return started(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->home(MotionKind::home, std::move(request), std::move(started)); });
}

void Controller::return_to_origin(HomeRequest request, TimePoint now, OnStarted started) {
  if (impl_->ending_) return started(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->home(MotionKind::return_to_origin, std::move(request), std::move(started)); });
}

void Controller::run_path(PathRequest request, TimePoint now, OnStarted started) {
  if (impl_->ending_) return started(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->run_path(std::move(request), std::move(started)); });
}

MotionId Controller::jog(JogRequest request, TimePoint now, OnStarted started) {
  if (impl_->ending_) {
    started(tl::unexpected(*impl_->ending_));
    return 0;
  }
  MotionId id = 0;
  impl_->at(now, [&] { id = impl_->jog(std::move(request), std::move(started)); });
  return id;
}

Result<void> Controller::renew_jog(MotionId id, const std::vector<JogRequest::Axis>& speeds, TimePoint now) {
  Result<void> renewed;
  impl_->at(now, [&] { renewed = impl_->renew_jog(id, speeds); });
  return renewed;
}

void Controller::end_jog(MotionId id, std::optional<Problem> why, TimePoint now) {
  impl_->at(now, [&] {
    const auto found = impl_->live_.find(id);
    if (found != impl_->live_.end()) impl_->end_jog(found->second, std::move(why));
  });
}

Result<void> Controller::check(const MoveRequest& request) const {
  const auto plan = impl_->check_move(request);
  if (!plan) return tl::unexpected(plan.error());
  return {};
}

Result<void> Controller::check(const PathRequest& request) const {
  const auto plan = impl_->plan_feasible_path(request);
  if (!plan) return tl::unexpected(plan.error());
  return {};
}

Result<void> Controller::check_use(const RequestContext& context, AxisSet axes) {
  return impl_->may_use(context, axes);
}

Result<void> Controller::check(const ScanRequest& request) const {
  const auto plan = impl_->plan_scan(request, {});
  if (!plan) return tl::unexpected(plan.error());
  return {};
}

void Controller::stop(AxisSet axes, const RequestContext& context, TimePoint now, OnStopped done) {
  impl_->at(now, [&] {
    impl_->permission_.stop_asked({context.who, context.lease, axes.empty() ? AxisSet::all() : axes, 0}, now);
    impl_->stop(axes, false, context, std::move(done));
  });
}

void Controller::emergency_stop(const RequestContext& context, TimePoint now, OnStopped done) {
  impl_->at(now, [&] {
    impl_->permission_.stop_asked({context.who, context.lease, AxisSet::all(), 0}, now);
    impl_->stop(AxisSet::all(), true, context, std::move(done));
  });
}

void Controller::clear_errors(AxisSet axes, const RequestContext& context, TimePoint now, OnDone done) {
  if (impl_->ending_) return done(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->executor_.spawn(impl_->clear_errors(axes, context, std::move(done))); });
}

void Controller::execute(ExecuteRequest request, TimePoint now, OnExecute event) {
  impl_->at(now, [&] { impl_->execute(std::move(request), std::move(event)); });
}

std::vector<Motion> Controller::motions() const {
  std::vector<Motion> all(impl_->ended_.begin(), impl_->ended_.end());
  for (const auto& [id, live] : impl_->live_) all.push_back(live->motion);
  return all;
}

std::optional<Motion> Controller::find_motion(MotionId id) const {
  if (const auto live = impl_->live_.find(id); live != impl_->live_.end()) return live->second->motion;
  for (const auto& motion : impl_->ended_) {
    if (motion.id == id) return motion;
  }
  return {};
}

void Controller::cancel_motion(MotionId id, const RequestContext& context, TimePoint now, OnDone done) {
  impl_->at(now, [&] { impl_->cancel(id, context, std::move(done)); });
}

void Controller::wind_down(TimePoint now, OnWoundDown done) {
  impl_->at(now, [&] { impl_->executor_.spawn(impl_->wind_down(std::move(done))); });
}

int Controller::owed_answers() const { return impl_->line_.owed(); }

std::size_t Controller::queued(Lane lane) const {
  return impl_->line_.queued(lane) + (lane == Lane::motion ? impl_->gate_.waiting() : 0);
}

}  // namespace axisgate::shrc203
