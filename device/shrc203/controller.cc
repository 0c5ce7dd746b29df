#include "device/shrc203/controller.h"

#include <utility>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/motion/approach.h"
#include "device/shrc203/motion/disarming.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/homes.h"
#include "device/shrc203/motion/jog_watchdog.h"
#include "device/shrc203/motion/jogs.h"
#include "device/shrc203/motion/moves.h"
#include "device/shrc203/motion/paths.h"
#include "device/shrc203/motion/prebuffer.h"
#include "device/shrc203/motion/saved_positions.h"
#include "device/shrc203/motion/scans.h"
#include "device/shrc203/motion/segment_halt.h"
#include "device/shrc203/motion/speeds.h"
#include "device/shrc203/motion/standstill.h"
#include "device/shrc203/motion/starter.h"
#include "device/shrc203/motion/trigger_count.h"
#include "device/shrc203/motion/watch.h"
#include "device/shrc203/session/clear_errors.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/ending.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/session/front_panel.h"
#include "device/shrc203/session/handshake.h"
#include "device/shrc203/session/lease_orders.h"
#include "device/shrc203/session/lease_settings.h"
#include "device/shrc203/session/non_host_visit.h"
#include "device/shrc203/session/polling.h"
#include "device/shrc203/session/previous_run.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/session/restart_check.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/session/session.h"
#include "device/shrc203/session/settings_reader.h"
#include "device/shrc203/session/stop_look.h"
#include "device/shrc203/session/stop_writer.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/session/wind_down.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/open_stops.h"
#include "device/shrc203/state/pending_restores.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/rights.h"
#include "device/shrc203/state/state_store.h"
#include "device/shrc203/transaction/transactions.h"

namespace axisgate::shrc203 {

// All rooms, wired to each other. `tasks` is destroyed last, since suspended procedures refer to all the others.
struct Controller::Rooms {
  Rooms(Profile settings, ByteLink& link, EventSink& events, Permission& keeper)
      : profile(std::move(settings)),
        permission(keeper),
        store(profile, events, tasks),
        line(model(), profile, link, tasks.executor(), session),
        rights(keeper, store, tasks),
        non_host(session),
        open_stops(store, tasks, session),
        motions(store, line, registers, rights, tasks, session) {}

  const Profile profile;
  Permission& permission;
  Tasks tasks;

  StateStore store;
  Line line;
  Ending ending;
  Registers registers;
  PendingRestores pending;
  Rights rights;
  NonHost non_host;
  OpenStops open_stops;
  Motions motions;

  Dialogue dialogue{line, tasks};
  FrontPanel panel{dialogue, line, store, non_host, tasks};
  Reader reader{dialogue, line, panel, store, registers, motions, tasks};
  SettingsReader settings_reader{dialogue, reader, store};
  Explainer explainer{dialogue, reader, line, store, registers, non_host, tasks};
  StopWriter stop_writer{dialogue, line, store, open_stops, non_host, tasks};
  StopLook stop_look{dialogue, reader, store, open_stops, registers, non_host, tasks};
  Stops stops{stop_writer, stop_look, line, store, open_stops, motions, tasks};
  PreviousRun previous_run{stops, store};
  LeaseSettings lease_settings{reader, store, pending, permission};
  Restorer restorer{dialogue, reader, store, motions, pending, permission, ending, tasks};
  LeaseOrders lease_orders{permission, stops, restorer, tasks};
  NonHostVisit non_host_visit{dialogue, line, reader, settings_reader, store, motions, registers, non_host, tasks};
  Handshake handshake{dialogue, line,    reader,    settings_reader, stops,      stop_writer, previous_run,
                      store,    motions, registers, non_host,        permission, tasks};
  RestartCheck restart_check{dialogue, line, reader, store, tasks};
  ErrorClearing error_clearing{dialogue, reader, store, open_stops, rights, non_host, tasks};
  WindDown wind_down{line, stops, restorer, store, motions, ending, tasks};
  Session session{line,  handshake, restart_check, stops,  stop_writer, previous_run,
                  store, motions,   registers,     rights, ending,      tasks};

  TriggerCount triggers{dialogue, store};
  Watch watch{line, reader, triggers, store, motions, tasks};
  Entry entry{dialogue, line, reader, explainer, restorer, store, motions, registers, tasks};
  Starter starter{dialogue, reader, explainer, store, motions, tasks};
  MotionSpeeds speeds{dialogue, explainer, store};
  Standstill standstill{reader, store, tasks};
  SegmentHalt halt{dialogue, explainer, standstill, triggers, store, motions, rights, tasks};
  Prebuffer prebuffer{dialogue, line, stops, standstill, store, motions, tasks};
  PathParts parts{line,     dialogue, starter, standstill, halt,    prebuffer, explainer,
                  triggers, watch,    store,   motions,    session, tasks};
  Disarming disarming{restorer, pending, store, tasks};
  PathFollower follower{parts, disarming, restorer, store};
  Approaches approaches{entry, follower, store, motions, line.timing()};
  JogWatchdog watchdog{dialogue, stops, store, motions, rights, tasks};

  Moves moves{entry, speeds, starter, watch, restorer, approaches, store, motions, rights, tasks};
  Homes homes{entry, speeds, starter, watch, restorer, store, motions, rights, tasks};
  Paths paths{entry, follower, store, motions, rights, line.timing(), tasks};
  Scans scans{entry, follower, triggers, reader, store, motions, rights, tasks};
  Jogs jogs{entry, speeds, starter, watch, watchdog, reader, restorer, stops, store, motions, rights, tasks};
  SavedPositions saved{dialogue, explainer, entry, speeds, starter, watch, restorer, store, motions, rights, tasks};
  TransactionStart transaction_start{dialogue, explainer, entry, lease_settings, restorer, reader, store, motions};
  TransactionLines transaction_lines{dialogue, explainer, reader, lease_settings, non_host_visit, session,
                                     non_host, pending,   store,  motions,        tasks};
  TransactionEnd transaction_end{line, reader, watch, non_host_visit, non_host, registers, store, motions, tasks};
  Transactions transactions{
      transaction_start, transaction_lines, transaction_end, stops, store, motions, rights, non_host, ending, tasks};
  Polling polling{reader, store, motions, non_host, tasks, [this] { return watch.watches_any(); }};
};

Controller::Controller(Profile profile, ByteLink& link, EventSink& events)
    : Controller(std::move(profile), link, events, everybody_may()) {}
Controller::Controller(Profile profile, ByteLink& link, EventSink& events, Permission& permission)
    : rooms_(std::make_unique<Rooms>(std::move(profile), link, events, permission)) {}
Controller::~Controller() = default;

// Runs a call from outside: sets the time first, then lets the tasks continue, and admits the motions that waited for a
// question which may have been sent now.
template <class Call>
void Controller::at(TimePoint now, Call call) {
  rooms_->tasks.now_is(now);
  call();
  rooms_->tasks.executor().run();
  rooms_->motions.gate().admit();
  rooms_->tasks.executor().run();
}

// Runs a caller's request. From the gateway's end on it is refused instead.
template <class Answer, class Call>
void Controller::unless_ending(const Answer& answer, TimePoint now, Call call) {
  rooms_->ending ? answer(tl::unexpected(*rooms_->ending)) : at(now, std::move(call));
}

void Controller::link_up(TimePoint now) {
  at(now, [&] { rooms_->line.link_up(now); });
}

void Controller::link_down(TimePoint now, std::string_view why) {
  at(now, [&] { rooms_->line.link_down(now, why); });
}

void Controller::receive(std::string_view bytes, TimePoint now) {
  at(now, [&] { rooms_->line.receive(bytes, now); });
}

void Controller::advance(TimePoint now) {
  at(now, [&] {
    rooms_->line.advance(now);
    rooms_->motions.expire_waiting();
    rooms_->lease_orders.carry_out();
    rooms_->tasks.executor().advance(now);
  });
}

std::optional<TimePoint> Controller::next_deadline() const {
  std::optional<TimePoint> next;
  for (const auto& at : {rooms_->line.next_deadline(rooms_->tasks.now()), rooms_->tasks.executor().next_deadline(),
                         rooms_->motions.gate().next_deadline(), rooms_->permission.next_deadline()}) {
    if (at && (!next || *at < *next)) next = at;
  }
  return next;
}

const Profile& Controller::profile() const { return rooms_->profile; }
const State& Controller::state() const { return rooms_->store.state(); }

void Controller::refresh(Duration max_age, const RequestContext& context, TimePoint now, OnState done) {
  unless_ending(done, now, [&] { rooms_->polling.refresh(max_age, context, std::move(done)); });
}

void Controller::move(MoveRequest request, TimePoint now, OnStarted started) {
  unless_ending(started, now, [&] { rooms_->moves.move(std::move(request), std::move(started)); });
}

void Controller::scan(ScanRequest request, TimePoint now, OnStarted started) {
  unless_ending(started, now, [&] { rooms_->scans.scan(std::move(request), std::move(started)); });
}

void Controller::home(HomeRequest request, TimePoint now, OnStarted started) {
  unless_ending(started, now, [&] { rooms_->homes.home(MotionKind::home, std::move(request), std::move(started)); });
}

void Controller::return_to_origin(HomeRequest request, TimePoint now, OnStarted started) {
  unless_ending(started, now,
                [&] { rooms_->homes.home(MotionKind::return_to_origin, std::move(request), std::move(started)); });
}

void Controller::run_path(PathRequest request, TimePoint now, OnStarted started) {
  unless_ending(started, now, [&] { rooms_->paths.run(std::move(request), std::move(started)); });
}

void Controller::go_to_position(GoToPositionRequest request, TimePoint now, OnStarted started) {
  unless_ending(started, now, [&] { rooms_->saved.go_to(std::move(request), std::move(started)); });
}

MotionId Controller::jog(JogRequest request, TimePoint now, OnStarted started) {
  MotionId id = 0;
  unless_ending(started, now, [&] { id = rooms_->jogs.jog(std::move(request), std::move(started)); });
  return id;
}

Result<void> Controller::renew_jog(MotionId id, const std::vector<JogRequest::Axis>& speeds, TimePoint now) {
  Result<void> renewed;
  at(now, [&] { renewed = rooms_->jogs.renew(id, speeds); });
  return renewed;
}

void Controller::end_jog(MotionId id, std::optional<Problem> why, TimePoint now) {
  at(now, [&] { rooms_->jogs.end(id, std::move(why)); });
}

Result<void> Controller::check_up() const {
  if (rooms_->ending) return tl::unexpected(*rooms_->ending);
  if (!rooms_->store.line_works()) return tl::unexpected(rooms_->store.not_up());
  return {};
}

Result<void> Controller::check(const MoveRequest& request) const {
  const auto plan = rooms_->moves.check(request);
  return plan ? Result<void>() : tl::unexpected(plan.error());
}

Result<void> Controller::check(const PathRequest& request) const {
  const auto plan = rooms_->paths.plan(request);
  return plan ? Result<void>() : tl::unexpected(plan.error());
}

Result<void> Controller::check(const ScanRequest& request) const { return rooms_->scans.check(request); }
Result<void> Controller::check(const GoToPositionRequest& request) const { return rooms_->saved.check(request); }

Result<void> Controller::check_use(const RequestContext& context, AxisSet axes) {
  return rooms_->rights.authorize(context, axes);
}

void Controller::stop(AxisSet axes, const RequestContext& context, TimePoint now, OnStopped done) {
  at(now, [&] {
    rooms_->motions.stop_requested(context, axes.empty() ? kAllAxes : axes);
    rooms_->stops.stop(axes, StopKind::stop, context, std::move(done));
  });
}

void Controller::emergency_stop(const RequestContext& context, TimePoint now, OnStopped done) {
  at(now, [&] {
    rooms_->motions.stop_requested(context, kAllAxes);
    rooms_->stops.stop(kAllAxes, StopKind::emergency, context, std::move(done));
  });
}

void Controller::withdraw_stop(StopId id, const RequestContext& context, TimePoint now, OnDone done) {
  at(now, [&] { rooms_->stops.withdraw(id, context, done); });
}

void Controller::clear_errors(AxisSet axes, const RequestContext& context, TimePoint now, OnDone done) {
  unless_ending(done, now, [&] { rooms_->error_clearing.clear(axes, context, std::move(done)); });
}

void Controller::execute(ExecuteRequest request, TimePoint now, OnExecute event) {
  at(now, [&] { rooms_->transactions.execute(std::move(request), std::move(event)); });
}

std::vector<Motion> Controller::motions() const { return rooms_->motions.all(); }
std::optional<Motion> Controller::find_motion(MotionId id) const { return rooms_->motions.find(id); }

void Controller::cancel_motion(MotionId id, const RequestContext& context, TimePoint now, OnDone done) {
  at(now, [&] {
    const auto live = rooms_->motions.find_live(id);
    if (live && live->life.has_turn()) rooms_->motions.stop_requested(context, live->motion.axes);
    rooms_->stops.cancel(id, context, std::move(done));
  });
}

void Controller::number_motions_after(MotionId last) { rooms_->motions.number_after(last); }

void Controller::inherit(const stage::Inheritance& left, TimePoint now) {
  rooms_->tasks.now_is(now);
  if (left.unfinished) rooms_->line.ask_line_before();
  rooms_->previous_run.inherit(left.unfinished);
  rooms_->stops.inherit(left);
}

void Controller::wind_down(TimePoint now, OnWoundDown done) {
  at(now, [&] { rooms_->tasks.spawn(rooms_->wind_down.run(std::move(done))); });
}

int Controller::outstanding_answers() const { return rooms_->line.outstanding(); }

std::size_t Controller::queued(Lane lane) const {
  return rooms_->line.queued(lane) + (lane == Lane::motion ? rooms_->motions.gate().waiting() : 0);
}

}  // namespace axisgate::shrc203
