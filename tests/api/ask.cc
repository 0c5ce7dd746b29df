#include "tests/api/ask.h"

#include "tests/api/ask_parts.h"

namespace axisgate::api {
namespace {

template <class Outcome, class Member, class... Arguments>
Reason answer_of(Member member, const Arguments&... arguments) {
  Asking<Outcome> asking;
  member(arguments..., asking.answer());
  return asking.reason();
}

template <class Value>
Reason reason_of(const Result<Value>& result) {
  return result ? Reason::unspecified : result.error().reason;
}

// Returns the reason after the first reading, because streams that follow a device do not end.
template <class Item>
Reason reason_of(const Opened<Item>& opened) {
  if (!opened) return opened.error().reason;
  if (*opened == nullptr) return Reason::unspecified;
  Reader<Item> reader(*opened);
  if (reader.next()) return Reason::unspecified;
  return reader.end().problem ? reader.end().problem->reason : Reason::unspecified;
}

class Seeker final : public LeaseSeeker {
 public:
  bool answer(Result<std::optional<server::Lease>> lease) override {
    asking_.answer()(std::move(lease));
    return true;
  }
  void when_gone(std::function<void()>) override {}
  Reason reason() { return asking_.reason(); }

 private:
  Asking<std::optional<server::Lease>> asking_;
};

Reason acquire(World& world, const Call& call) {
  const auto seeker = std::make_shared<Seeker>();
  world.api->leases.acquire(call, kDevice, LeaseWish(), Duration(), seeker);
  return seeker->reason();
}

Reason take_over(World& world, const Call& call) {
  const auto seeker = std::make_shared<Seeker>();
  world.api->leases.take_over(call, kDevice, LeaseWish(), seeker);
  return seeker->reason();
}

Reason keep_alive(World& world, const Call& call) {
  const auto keeping = world.api->leases.keep_alive(call);
  if (!keeping) return keeping.error().reason;
  Reader<server::Lease> reader(*keeping);
  (*keeping)->keep(kDevice, call.lease_token);
  if (reader.next()) (*keeping)->finish();
  return reader.reason();
}

Reason jog(World& world, const Call& call) {
  const auto jog = world.api->jogs.open(call.credential);
  if (!jog) return jog.error().reason;
  Reader<CurrentMotion> reader(*jog);
  (*jog)->start(call, kDevice, std::vector<JogAxis>{{.axis = 1, .direction = 1}});
  if (reader.next()) (*jog)->finish();
  return reader.reason();
}

Reason run_path(World& world, const Call& call) {
  const auto path = world.api->paths.open(call.credential);
  if (!path) return path.error().reason;
  Reader<PathStep> reader(*path);
  const bool taken = (*path)->start(call, kDevice);
  if (taken &&
      (*path)->add(stage::Segment{
          .moves = {{.axis = 1, .distance = pulses(10), .profile = {}}}, .speed = {}, .acceleration_ms = {}})) {
    (*path)->run("");
  }
  return reader.reason();
}

Reason ask_motions(World& world, RequestKind kind, const Call& call) {
  const Motions& motions = world.api->motions;
  Asking<StartedMotion> started;
  switch (kind) {
    case RequestKind::move:
      motions.move(call, kDevice, World::way_of(10), started.answer());
      break;
    case RequestKind::home:
      motions.home(call, kDevice, stage::AxisSet(), started.answer());
      break;
    case RequestKind::return_to_origin:
      motions.return_to_origin(call, kDevice, stage::AxisSet(), started.answer());
      break;
    case RequestKind::scan:
      motions.scan(call, kDevice, World::scan(), started.answer());
      break;
    case RequestKind::move_to_position:
      world.api->positions.move_to(call, kSaved, started.answer());
      break;
    default:
      return Reason::internal;
  }
  const Reason reason = started.reason();
  EXPECT_TRUE(world.all_ended());
  return reason;
}

Reason ask_motion(World& world, RequestKind kind, const Call& call) {
  const Motions& motions = world.api->motions;
  const auto with = [&](auto member) { return [&motions, member](const auto&... all) { (motions.*member)(all...); }; };
  switch (kind) {
    case RequestKind::get_motion:
      return answer_of<CurrentMotion>(with(&Motions::get), call, kUnknownMotion);
    case RequestKind::list_motions:
      return answer_of<std::vector<CurrentMotion>>(with(&Motions::list), call, kDevice);
    case RequestKind::cancel_motion:
      return answer_of<void>(with(&Motions::cancel), call, kUnknownMotion);
    default:
      return reason_of(motions.watch(call, kUnknownMotion));
  }
}

// Sends a request for mills. Its device is the stage, the only device.
Reason ask_mills(World& world, RequestKind kind, const Call& call) {
  constexpr const char* kJob = "devices/turn/jobs/1";
  const MillSubjects& mill = world.api->mill;
  const auto with = [](const auto& of, auto act) { return [&of, act](const auto&... all) { (of.*act)(all...); }; };
  switch (kind) {
    case RequestKind::send_job:
      return reason_of(mill.sending.send(call, kDevice, {}));
    case RequestKind::repeat_job:
      return answer_of<CurrentJob>(with(mill.sending, &JobSending::repeat), call, kJob, JobToRepeat());
    case RequestKind::get_mill:
      return answer_of<MillState>(with(mill.mills, &Mills::get), call, kDevice);
    case RequestKind::confirm_job:
      return answer_of<CurrentJob>(with(mill.waiting, &WaitingJobs::confirm), call, kJob, jobs::JobSetup());
    case RequestKind::start_job:
      return answer_of<CurrentJob>(with(mill.starts, &JobStarts::start), call, kJob);
    case RequestKind::pause_job:
      return answer_of<CurrentRun>(with(mill.mills, &Mills::pause), call, kDevice, false);
    case RequestKind::resume_job:
      return answer_of<CurrentRun>(with(mill.mills, &Mills::resume), call, kDevice);
    case RequestKind::continue_job:
      return answer_of<CurrentJob>(with(mill.starts, &JobStarts::choose_rest), call, kJob, LineToChoose());
    case RequestKind::abort_job:
      return answer_of<CurrentRun>(with(mill.mills, &Mills::abort), call, kDevice);
    case RequestKind::cancel_job:
      return answer_of<CurrentJob>(with(mill.waiting, &WaitingJobs::cancel), call, kJob);
    case RequestKind::cancel_jobs:
      return answer_of<CancelledJobs>(with(mill.waiting, &WaitingJobs::cancel_all), call, kDevice,
                                      std::string("unix anna"));
    case RequestKind::move_job:
      return answer_of<CurrentJob>(with(mill.waiting, &WaitingJobs::move_first), call, kJob);
    case RequestKind::report_job_done:
      return answer_of<CurrentJob>(with(mill.waiting, &WaitingJobs::done), call, kJob);
    case RequestKind::operate_mill:
      return answer_of<Duration>(with(mill.operation, &MillOperation::operate), call, kDevice,
                                 HandRequest{jobs::RaiseTool()});
    default:
      return reason_of(mill.mills.watch(call, kDevice));
  }
}

Reason ask_settings(World& world, RequestKind kind, const Call& call) {
  const Settings& settings = world.api->settings;
  Asking<void> done;
  Asking<stage::Settings> answer;
  switch (kind) {
    case RequestKind::get_settings:
      settings.get(call, kDevice, answer.answer());
      return answer.reason();
    case RequestKind::change_settings:
      settings.change(call, kDevice, SettingsChange{.beep = true}, done.answer());
      break;
    case RequestKind::set_coordinates:
      settings.set_coordinates(call, kDevice, NewCoordinates{{1, SetOrigin{}}}, done.answer());
      break;
    case RequestKind::fire_trigger:
      settings.fire_trigger(call, kDevice, done.answer());
      break;
    default:
      settings.reset(call, kDevice, done.answer());
  }
  return done.reason();
}

Reason ask_leases(World& world, RequestKind kind, const Call& call) {
  const Leases& leases = world.api->leases;
  Asking<void> done;
  Asking<std::vector<server::Latch>> lifted;
  switch (kind) {
    case RequestKind::acquire_lease:
      return acquire(world, call);
    case RequestKind::take_over_lease:
      return take_over(world, call);
    case RequestKind::keep_lease_alive:
      return keep_alive(world, call);
    case RequestKind::watch_leases:
      return reason_of(leases.watch(call, kDevice));
    case RequestKind::rearm:
      leases.rearm(call, kDevice, lifted.answer());
      return lifted.reason();
    case RequestKind::release_lease:
      leases.release(call, kDevice, done.answer());
      break;
    default:
      leases.hand_over(call, kDevice, "unix nobody", done.answer());
  }
  return done.reason();
}

Reason ask_positions(World& world, RequestKind kind, const Call& call) {
  const Positions& positions = world.api->positions;
  Asking<std::optional<NamedPosition>> saved;
  Asking<std::vector<NamedPosition>> all;
  Asking<void> done;
  switch (kind) {
    case RequestKind::save_position:
      positions.save(call, "devices/turn/positions/new", PositionWish(), saved.answer());
      return saved.reason();
    case RequestKind::list_positions:
      positions.list(call, kDevice, all.answer());
      return all.reason();
    default:
      positions.remove(call, kSaved, done.answer());
      return done.reason();
  }
}

Reason ask_devices(World& world, RequestKind kind, const Call& call) {
  const Devices& devices = world.api->devices;
  Asking<DeviceNow> state;
  Asking<void> done;
  Asking<std::string> text;
  switch (kind) {
    case RequestKind::list_devices:
      return reason_of(devices.list(call));
    case RequestKind::get_device:
      devices.get(call, kDevice, Duration(), state.answer());
      return state.reason();
    case RequestKind::watch_device:
      return reason_of(devices.watch(call, kDevice, Duration()));
    case RequestKind::clear_errors:
      devices.clear_errors(call, kDevice, stage::AxisSet(), done.answer());
      return done.reason();
    case RequestKind::withdraw_stop:
      devices.withdraw_stop(call, std::string(kDevice) + "/stops/1", done.answer());
      return done.reason();
    case RequestKind::operate_simulator:
      world.api->simulators.operate(call, kDevice, "position", text.answer());
      return text.reason();
    case RequestKind::list_commands:
      return reason_of(world.api->commands.list(call, kDevice));
    default:
      return reason_of(world.api->commands.execute(call, kDevice, {{"L:1"}}));
  }
}

Reason ask_stops(World& world, RequestKind kind, const Call& call) {
  Asking<std::vector<DeviceStop>> report;
  if (kind == RequestKind::stop) {
    world.api->stops.stop(call, kDevice, stage::AxisSet(), report.answer());
  } else {
    world.api->stops.emergency_stop(call, kDevice, report.answer());
  }
  return report.reason();
}

}  // namespace

void save_position(World& world) {
  server::SavedPosition position{.device = "turn", .name = "saved", .number = 1};
  position.serial_number = world.state().serial_number;
  ASSERT_TRUE(world.positions->keep(position));
}

Reason ask(World& world, RequestKind kind, const Call& call) {
  using Kind = RequestKind;
  if (is_unary_form(kind)) return ask_unary_form(world, kind, call);
  switch (kind) {
    case Kind::get_caller:
    case Kind::create_token:
    case Kind::list_tokens:
    case Kind::revoke_token:
      return ask_tokens(world, kind, call);
    case Kind::acquire_lease:
    case Kind::keep_lease_alive:
    case Kind::release_lease:
    case Kind::hand_over_lease:
    case Kind::take_over_lease:
    case Kind::watch_leases:
    case Kind::rearm:
      return ask_leases(world, kind, call);
    case Kind::list_devices:
    case Kind::get_device:
    case Kind::watch_device:
    case Kind::clear_errors:
    case Kind::withdraw_stop:
    case Kind::operate_simulator:
    case Kind::list_commands:
    case Kind::execute:
      return ask_devices(world, kind, call);
    case Kind::record:
    case Kind::get_support_report:
    case Kind::watch_events:
      return ask_readers(world, kind, call);
    case Kind::list_history:
    case Kind::summarize_history:
    case Kind::verify_journal:
    case Kind::erase_person:
      return ask_history(world, kind, call);
    case Kind::save_position:
    case Kind::list_positions:
    case Kind::delete_position:
      return ask_positions(world, kind, call);
    case Kind::get_settings:
    case Kind::change_settings:
    case Kind::set_coordinates:
    case Kind::fire_trigger:
    case Kind::reset_device:
      return ask_settings(world, kind, call);
    case Kind::move:
    case Kind::home:
    case Kind::return_to_origin:
    case Kind::scan:
    case Kind::move_to_position:
      return ask_motions(world, kind, call);
    case Kind::run_path:
      return run_path(world, call);
    case Kind::jog:
      return jog(world, call);
    case Kind::stop:
    case Kind::emergency_stop:
      return ask_stops(world, kind, call);
    case Kind::get_motion:
    case Kind::list_motions:
    case Kind::watch_motion:
    case Kind::cancel_motion:
      return ask_motion(world, kind, call);
    case Kind::ask_server:
    case Kind::watch_server:
    case Kind::unlisted:
      return Reason::internal;
    default:
      return ask_mills(world, kind, call);
  }
}

}  // namespace axisgate::api
