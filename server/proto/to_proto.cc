#include "server/proto/to_proto.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <variant>

#include "device/core/escape.h"
#include "device/link/clock.h"
#include "device/stage/envelope.h"
#include "server/api/request/names.h"
#include "server/proto/amounts.h"
#include "server/proto/callers.h"
#include "server/proto/mills.h"
#include "server/proto/motions.h"
#include "server/proto/problem.h"

namespace axisgate::proto {
namespace {

using stage::LinkState;

v1::LinkState to_link_state(LinkState state) {
  static_assert(static_cast<int>(LinkState::down) + 1 == v1::LINK_STATE_DOWN);
  static_assert(static_cast<int>(LinkState::connecting) + 1 == v1::LINK_STATE_CONNECTING);
  static_assert(static_cast<int>(LinkState::up) + 1 == v1::LINK_STATE_UP);
  static_assert(static_cast<int>(LinkState::doubtful) + 1 == v1::LINK_STATE_DOUBTFUL);
  static_assert(static_cast<int>(LinkState::babbling) + 1 == v1::LINK_STATE_BABBLING);
  return static_cast<v1::LinkState>(static_cast<int>(state) + 1);
}

void fill_stage(int number, const stage::Profile& profile, const stage::State& state, v1::Axis& axis) {
  const auto& stage = profile.axis(number).stage;
  if (!stage) return;
  axis.set_stage(stage->model);
  const auto fits = stage::Envelope(profile, state, "", "").check_stage(number);
  if (!fits) axis.set_stage_problem(fits.error().message);
  const stage::AxisState& now = state.axis(number);
  if (!stage->modulo || !now.position_pulses || !now.scale) return;
  const Result<Decimal> place = within_turn(*now.position_pulses, *stage->modulo, *now.scale);
  if (place) axis.set_position_in_turn(to_string(*place));
}

void fill_limits(const stage::AxisProfile& profile, v1::Axis& axis) {
  if (profile.travel_minimum) *axis.mutable_travel_minimum() = to_distance(*profile.travel_minimum);
  if (profile.travel_maximum) *axis.mutable_travel_maximum() = to_distance(*profile.travel_maximum);
  if (profile.maximum_speed) *axis.mutable_speed_limit() = to_speed(*profile.maximum_speed);
  axis.set_require_homing(profile.require_homing);
}

void fill_axis(int number, const stage::AxisProfile& profile, const stage::AxisState& state, v1::Axis& axis) {
  axis.set_number(number);
  axis.set_name(profile.name);
  axis.set_unit(to_proto(profile.unit));
  axis.set_controllable(state.controllable);
  if (state.position_pulses) axis.set_position_pulses(*state.position_pulses);
  axis.set_position(position_text(state.position_pulses, state.scale, profile.unit));
  if (state.busy) axis.set_busy(*state.busy);
  axis.set_foreign_motion(state.foreign_motion);
  axis.set_armed(state.armed);
  if (state.excited) axis.set_excited(*state.excited);
  axis.set_homed(state.homed);
  axis.set_status_bits(state.status_bits);
  if (state.controllable) {
    for (const auto condition : stage::listed(state.conditions)) {
      axis.add_conditions(to_condition(condition));
    }
  }
  fill_limits(profile, axis);
  if (state.scale) {
    axis.set_per_pulse(to_string(state.scale->per_pulse));
    axis.set_rotary(state.scale->rotary);
  }
  v1::Profile& speeds = *axis.mutable_speeds();
  if (state.minimum_speed) speeds.mutable_minimum()->set_pulses_per_s(*state.minimum_speed);
  if (state.maximum_speed) speeds.mutable_maximum()->set_pulses_per_s(*state.maximum_speed);
  if (state.acceleration_ms) {
    *speeds.mutable_acceleration_time() = to_proto(std::chrono::milliseconds(*state.acceleration_ms));
  }
}

void fill_age(TimePoint read, v1::Device& device) {
  if (read == TimePoint{}) return;
  const Duration age = std::max(Duration::zero(), monotonic_now() - read);
  *device.mutable_age() = to_proto(age);
  *device.mutable_read_time() = to_proto(server::to_wall(read));
}

v1::StopChange::State to_stop_state(stage::StopState state) {
  switch (state) {
    case stage::StopState::asked:
    case stage::StopState::written:
      return v1::StopChange::STATE_OPEN;
    case stage::StopState::confirmed:
      return v1::StopChange::STATE_CONFIRMED;
    case stage::StopState::replaced:
      return v1::StopChange::STATE_REPLACED;
    case stage::StopState::withdrawn:
      break;
  }
  return v1::StopChange::STATE_WITHDRAWN;
}

void fill_stops(const std::string& device, const stage::State& state, v1::Device& proto) {
  for (const stage::Stop& stop : state.open_stops) {
    v1::OpenStop& one = *proto.add_open_stops();
    one.set_name(api::stop_name(device, stop.id));
    for (const int axis : stop.axes.list()) one.add_axes(axis);
    one.set_emergency(stop.kind == stage::StopKind::emergency);
    for (const std::string& who : stop.callers) *one.add_callers() = to_caller(who);
    *one.mutable_request_time() = to_proto(server::to_wall(stop.asked));
    one.set_written(stop.state == stage::StopState::written);
    one.set_late(stop.late);
    one.set_stale_setpoint(stop.stale);
  }
  if (!state.emergency) return;
  *proto.mutable_emergency_latch()->mutable_caller() = to_caller(state.emergency->who);
  *proto.mutable_emergency_latch()->mutable_request_time() = to_proto(server::to_wall(state.emergency->at));
}

// An EventFiller writes each type of fact to its field of an Event.
struct EventFiller {
  const server::FactRecord& record;
  const Shown shown;
  v1::Event& event;

  void operator()(const stage::MotionChanged& change) const {
    *event.mutable_motion() = to_proto(record.device, change.motion, record.revision, record.clock, shown);
  }
  void operator()(const stage::CompletionSeen& seen) const {
    event.mutable_completion()->set_axis(seen.axis);
    if (seen.motion != 0) event.mutable_completion()->set_motion(api::motion_name(record.device, seen.motion));
  }
  void operator()(const stage::PathProgress& progress) const {
    *event.mutable_path_progress() = to_proto(record.device, progress);
  }
  void operator()(const stage::LinkChanged& change) const {
    event.mutable_link()->set_state(to_link_state(change.link));
    event.mutable_link()->set_why(change.why);
  }
  void operator()(const stage::ForeignMotion& motion) const {
    for (const int axis : motion.axes.list()) event.mutable_foreign_motion()->add_axes(axis);
  }
  void operator()(const stage::ConditionChanged& change) const {
    v1::ConditionChange& proto = *event.mutable_condition();
    proto.set_condition(to_condition(change.condition));
    for (const int axis : change.axes.list()) proto.add_axes(axis);
    proto.set_begun(change.begun);
    proto.set_value(escaped(change.value));
    if (change.before != TimePoint{}) *proto.mutable_before_time() = to_proto(record.clock.at(change.before));
    *proto.mutable_seen_time() = to_proto(record.clock.at(change.seen));
  }
  void operator()(const stage::SwitchesChanged& change) const {
    v1::SwitchesChanged& switches = *event.mutable_switches_changed();
    *switches.mutable_caller() = to_caller(change.who);
    switches.set_unknown(change.unknown);
    for (const auto& one : change.changes) {
      v1::SwitchChange& proto = *switches.add_changes();
      proto.set_item(one.item);
      proto.set_number(one.number);
      proto.set_before(escaped(one.before));
      proto.set_after(escaped(one.after));
    }
  }
  void operator()(const stage::ProgramNotice& notice) const {
    static_assert(static_cast<int>(stage::ProgramNotice::Kind::trigger) + 1 == v1::ProgramNotice::KIND_TRIGGER);
    event.mutable_program_notice()->set_kind(static_cast<v1::ProgramNotice::Kind>(static_cast<int>(notice.kind) + 1));
    event.mutable_program_notice()->set_count(notice.count);
  }
  void operator()(const stage::StopRequested& stop) const {
    for (const int axis : stop.axes.list()) event.mutable_stop_requested()->add_axes(axis);
    event.mutable_stop_requested()->set_emergency(stop.emergency);
    *event.mutable_stop_requested()->mutable_caller() = to_caller(stop.who);
    event.mutable_stop_requested()->set_count(stop.count);
  }
  void operator()(const stage::StopChanged& change) const {
    const stage::Stop& stop = change.stop;
    v1::StopChange& proto = *event.mutable_stop();
    proto.set_name(api::stop_name(record.device, stop.id));
    proto.set_state(to_stop_state(stop.state));
    for (const int axis : stop.axes.list()) proto.add_axes(axis);
    proto.set_emergency(stop.kind == stage::StopKind::emergency);
    for (const std::string& who : stop.callers) *proto.add_callers() = to_caller(who);
    if (!is_open(stop.state)) *proto.mutable_elapsed_time() = to_proto(stop.ended - stop.asked);
    for (const auto& [axis, pulses] : stop.came_to) {
      v1::AxisRest& rest = *proto.add_rests();
      rest.set_axis(axis);
      rest.set_position_pulses(pulses);
      shown.describe(axis, rest);
      rest.set_position(shown.text(axis, pulses));
    }
    if (stop.replaced_by != 0) proto.set_replaced_by(api::stop_name(record.device, stop.replaced_by));
    if (!stop.withdrawn_by.empty()) *proto.mutable_withdrawn_by() = to_caller(stop.withdrawn_by);
  }
  void operator()(const stage::EmergencyLatchChanged& change) const {
    event.mutable_emergency_latch()->set_latched(change.latch.has_value());
    *event.mutable_emergency_latch()->mutable_caller() = to_caller(change.who);
  }
  void operator()(const server::DaemonStarted& started) const {
    event.mutable_daemon_started()->set_after_unclean_end(started.after_unclean_end);
  }
  void operator()(const server::JobChanged& change) const {
    v1::JobChange& proto = *event.mutable_job();
    *proto.mutable_job() = to_proto(record.device, change.job, record.clock);
    if (change.sending) proto.set_sending(to_sending_state(*change.sending));
    if (!change.who.empty()) *proto.mutable_caller() = to_caller(change.who);
    proto.set_why(change.why);
  }
};

}  // namespace

void fill_trigger(const stage::Trigger& trigger, v1::Trigger& proto) {
  using Target = stage::Trigger::Target;
  static_assert(static_cast<int>(Target::none) + 1 == v1::Trigger::TARGET_NONE);
  static_assert(static_cast<int>(Target::scale_minus) + 1 == v1::Trigger::TARGET_SCALE_MINUS);
  proto.set_target(static_cast<v1::Trigger::Target>(static_cast<int>(trigger.target) + 1));
  if (trigger.axis != 0) proto.set_axis(std::to_string(trigger.axis));
  switch (trigger.target) {
    case Target::none:
      break;
    case Target::drive_pulses:
      proto.mutable_distance()->set_pulses(trigger.interval);
      break;
    case Target::timer:
      *proto.mutable_period() = to_proto(std::chrono::milliseconds(10 * trigger.interval));
      break;
    case Target::scale_plus:
    case Target::scale_minus:
      proto.set_scale_pulses(trigger.interval);
      break;
  }
}

v1::Condition to_condition(stage::Condition condition) {
  static_assert(static_cast<int>(stage::Condition::unnamed_error) == v1::CONDITION_UNNAMED_ERROR);
  static_assert(static_cast<int>(stage::Condition::format) == v1::CONDITION_FORMAT);
  return static_cast<v1::Condition>(static_cast<int>(condition));
}

google::protobuf::Timestamp to_proto(server::WallTime time) {
  const auto since_epoch = time.time_since_epoch();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since_epoch);
  google::protobuf::Timestamp stamp;
  stamp.set_seconds(seconds.count());
  stamp.set_nanos(static_cast<std::int32_t>(std::chrono::nanoseconds(since_epoch - seconds).count()));
  return stamp;
}

v1::Device to_proto(const server::Stage& device, const stage::State& state) {
  v1::Device proto;
  proto.set_name(api::device_name(device.name()));
  proto.set_kind(std::string(device.kind().name()));
  proto.set_link(to_link_state(state.link));
  proto.set_link_problem(state.link_problem);
  proto.set_vendor(escaped(state.vendor));
  proto.set_model(escaped(state.model));
  proto.set_serial_number(escaped(state.serial_number));
  proto.set_firmware(escaped(state.firmware));
  proto.set_mode(to_mode(state.mode));
  proto.set_format(to_format(state.format));
  for (const stage::Capability capability : device.kind().capabilities()) {
    static_assert(static_cast<int>(stage::Capability::commands) + 1 == v1::CAPABILITY_COMMANDS);
    proto.add_capabilities(static_cast<v1::Capability>(static_cast<int>(capability) + 1));
  }
  proto.set_device_epoch(state.device_epoch);
  proto.set_frame_epoch(state.frame_epoch);
  for (int number = 1; number <= device.kind().axis_count(); ++number) {
    v1::Axis& axis = *proto.add_axes();
    fill_axis(number, device.profile().axis(number), state.axis(number), axis);
    fill_stage(number, device.profile(), state, axis);
  }
  if (state.outputs) *proto.mutable_outputs() = to_pins(*state.outputs);
  if (state.trigger) fill_trigger(*state.trigger, *proto.mutable_trigger());
  proto.set_moving_unknown(state.moving_unknown);
  fill_stops(device.name(), state, proto);
  fill_age(state.read, proto);
  return proto;
}

v1::Event to_proto(const server::FactRecord& record, const server::Stage* stage) {
  v1::Event event;
  event.set_revision(record.revision);
  *event.mutable_time() = to_proto(record.time);
  if (!record.device.empty()) event.set_device(api::device_name(record.device));
  event.set_run(record.run);
  std::visit(EventFiller{record, Shown(stage), event}, record.fact);
  return event;
}

v1::DeviceStop to_proto(const api::DeviceStop& stop) {
  v1::DeviceStop proto;
  proto.set_device(api::device_name(stop.device->name()));
  const auto* stage = dynamic_cast<const server::Stage*>(stop.device);
  for (const stage::StopReport::Axis& axis : stop.report.axes) {
    const stage::AxisProfile& profile = stage->profile().axis(axis.axis);
    v1::AxisStop& one = *proto.add_axes();
    one.set_axis(axis.axis);
    one.set_wire_reply(escaped(axis.wire_reply));
    one.set_named(axis.named);
    one.set_reply_unreadable(axis.reply_unreadable);
    if (axis.ready) one.set_ready(*axis.ready);
    if (axis.position_pulses) one.set_position_pulses(*axis.position_pulses);
    one.set_name(profile.name);
    one.set_unit(to_proto(profile.unit));
    one.set_position(position_text(axis.position_pulses, stop.state.axis(axis.axis).scale, profile.unit));
  }
  if (stop.report.problem) *proto.mutable_problem() = to_proto(*stop.report.problem);
  proto.set_stays_open(stop.report.stays_open);
  if (stop.report.stop != 0) proto.set_stop(api::stop_name(stop.device->name(), stop.report.stop));
  return proto;
}

}  // namespace axisgate::proto
