#include "clients/cpp/src/outcomes.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <utility>

#include "clients/cpp/src/amounts.h"
#include "clients/cpp/src/failure.h"

namespace axisgate::client {
namespace {

using google::protobuf::util::TimeUtil;

// Returns the name of an enum's value without the prefix; the number of a value of a newer daemon.
std::string without_prefix(const std::string& name, std::string_view prefix, int number) {
  return name.empty() ? std::to_string(number) : name.substr(prefix.size());
}

// Position in an AxisResult, AxisStop or Axis, whose fields have different names for the pulses.
Position position_of(const auto& axis, std::optional<std::int64_t> pulses) {
  return {axis.name(), axis.position(), unit_text(axis.unit()), pulses};
}

template <class Number>
std::optional<std::int64_t> optional_of(bool has, Number number) {
  return has ? std::optional<std::int64_t>(number) : std::nullopt;
}

MotionResult result_of(const v1::Motion& motion) {
  MotionResult result;
  result.motion = motion.name();
  const auto& began = motion.has_start_time() ? motion.start_time() : motion.create_time();
  result.duration = std::chrono::nanoseconds(TimeUtil::DurationToNanoseconds(motion.end_time() - began));
  for (const v1::AxisResult& one : motion.results()) {
    Position position = position_of(one, optional_of(one.has_command_pulses(), one.command_pulses()));
    position.axis = axis_name(one.name(), one.axis());
    result.positions.push_back(std::move(position));
  }
  if (motion.has_scan()) {
    const v1::Scan& scan = motion.scan();
    result.scan = ScanResult{
        .expected = optional_of(scan.has_expected_triggers(), scan.expected_triggers()),
        .expected_in_range = optional_of(scan.has_expected_triggers_in_range(), scan.expected_triggers_in_range()),
        .observed = optional_of(scan.has_observed_triggers(), scan.observed_triggers())};
  }
  return result;
}

std::optional<Distance> limit_of(const v1::Distance& limit) {
  switch (limit.amount_case()) {
    case v1::Distance::kPulses:
      return pulses(limit.pulses());
    case v1::Distance::kNm:
      return nm(limit.nm());
    case v1::Distance::kUm:
      return um(limit.um());
    case v1::Distance::kMm:
      return mm(limit.mm());
    case v1::Distance::kDegrees:
      return deg(limit.degrees());
    default:
      return std::nullopt;
  }
}

AxisState axis_state_of(const v1::Axis& axis) {
  AxisState state;
  state.number = axis.number();
  state.name = axis_name(axis.name(), axis.number());
  state.position = position_of(axis, optional_of(axis.has_position_pulses(), axis.position_pulses()));
  state.position.axis = state.name;
  if (axis.has_busy()) state.moving = axis.busy();
  if (axis.has_excited()) state.motor_on = axis.excited();
  state.homed = axis.homed();
  state.minimum = limit_of(axis.travel_minimum());
  state.maximum = limit_of(axis.travel_maximum());
  for (const int condition : axis.conditions()) {
    state.conditions.push_back(
        without_prefix(v1::Condition_Name(static_cast<v1::Condition>(condition)), "CONDITION_", condition));
  }
  return state;
}

// Returns the part of its distance that an axis has covered; nullopt if unknown.
std::optional<double> covered(const AxisState& first, const AxisState& now, const v1::AxisResult& result) {
  if (!first.position.pulses || !now.position.pulses || !result.has_target_pulses()) return std::nullopt;
  const auto distance = static_cast<double>(result.target_pulses() - *first.position.pulses);
  if (distance == 0) return std::nullopt;
  return static_cast<double>(*now.position.pulses - *first.position.pulses) / distance;
}

}  // namespace

MotionResult outcome_of(const v1::Motion& motion) {
  ErrorParts parts = to_parts(motion.problem());
  switch (motion.state()) {
    case v1::MOTION_STATE_SUCCEEDED:
      return result_of(motion);
    case v1::MOTION_STATE_STOPPED:
      throw Stopped(std::move(parts));
    case v1::MOTION_STATE_UNKNOWN:
      throw OutcomeUnknown(std::move(parts));
    default:
      throw MotionFailed(std::move(parts));
  }
}

Progress progress_of(const v1::Motion& motion, const v1::Device& first, const v1::Device& now) {
  Progress progress;
  progress.segment = motion.segments_done();
  if (motion.segments_total() > 0) {
    progress.fraction = static_cast<double>(motion.segments_done()) / motion.segments_total();
  }
  const Status before = status_of(first), present = status_of(now);
  for (const v1::AxisResult& result : motion.results()) {
    const std::string name = axis_name(result.name(), result.axis());
    const AxisState& state = present.axis(name);
    progress.positions.push_back(state.position);
    const auto part = covered(before.axis(name), state, result);
    if (part && motion.segments_total() == 0) progress.fraction = std::min(progress.fraction.value_or(*part), *part);
  }
  return progress;
}

StopReport report_of(const google::protobuf::RepeatedPtrField<v1::DeviceStop>& devices, bool stays_open) {
  StopReport report;
  report.stays_open = stays_open;
  for (const v1::DeviceStop& device : devices) {
    for (const v1::AxisStop& one : device.axes()) {
      AxisStop axis{position_of(one, optional_of(one.has_position_pulses(), one.position_pulses())), std::nullopt};
      axis.position.axis = axis_name(one.name(), one.axis());
      if (one.has_ready()) axis.stationary = one.ready();
      report.axes.push_back(std::move(axis));
    }
    if (device.has_problem() && !report.problem) report.problem = Error(to_parts(device.problem()));
  }
  return report;
}

Status status_of(const v1::Device& device) {
  Status status;
  status.device = last_part(device.name());
  status.link = without_prefix(v1::LinkState_Name(device.link()), "LINK_STATE_", device.link());
  status.link_problem = device.link_problem();
  status.mode = without_prefix(v1::Mode_Name(device.mode()), "MODE_", device.mode());
  for (const v1::Axis& axis : device.axes()) {
    if (axis.controllable()) status.axes.push_back(axis_state_of(axis));
  }
  return status;
}

std::string state_name(v1::MotionState state) {
  return without_prefix(v1::MotionState_Name(state), "MOTION_STATE_", state);
}

std::string axis_name(const std::string& name, int number) { return name.empty() ? std::to_string(number) : name; }

std::string last_part(std::string_view resource) { return std::string(resource.substr(resource.rfind('/') + 1)); }

}  // namespace axisgate::client
