#include "server/proto/settings.h"

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <utility>
#include <variant>

#include "server/api/stage/targets.h"
#include "server/proto/amounts.h"
#include "server/proto/targets.h"
#include "server/proto/to_proto.h"

namespace axisgate::proto {
namespace {

Result<std::optional<api::Speeds>> to_axis_speeds(int axis, bool given, const v1::Profile& profile) {
  if (!given) return std::nullopt;
  const Result<api::Speeds> speeds = to_speeds(profile);
  if (!speeds) return tl::unexpected(api::on_axis(axis, speeds.error()));
  return *speeds;
}

Result<api::AxisChange> to_axis_change(const v1::AxisSettings& settings, const api::AxisNames& names) {
  const Result<int> axis = names.find(settings.axis());
  if (!axis) return tl::unexpected(axis.error());
  api::AxisChange change{.axis = *axis};
  if (settings.has_closed_loop()) change.closed_loop = settings.closed_loop();
  if (settings.has_excited()) change.excited = settings.excited();
  if (settings.has_divisions()) change.divisions = settings.divisions();
  const auto speeds = to_axis_speeds(*axis, settings.has_speeds(), settings.speeds());
  if (!speeds) return tl::unexpected(speeds.error());
  change.speeds = *speeds;
  const auto origin = to_axis_speeds(*axis, settings.has_origin_speeds(), settings.origin_speeds());
  if (!origin) return tl::unexpected(origin.error());
  change.origin_speeds = *origin;
  change.names_given = !settings.name_on_device().empty() || !settings.scale_resolution().empty();
  return change;
}

// Negative, and so out of range, if `duration` is not valid.
Duration to_settling(const google::protobuf::Duration& duration) {
  return duration.nanos() < 1'000'000'000 ? to_duration(duration) : Duration(-1);
}

// The interval that a target of the trigger needs.
v1::Trigger::IntervalCase interval_of(v1::Trigger::Target target) {
  switch (target) {
    case v1::Trigger::TARGET_DRIVE_PULSES:
      return v1::Trigger::kDistance;
    case v1::Trigger::TARGET_TIMER:
      return v1::Trigger::kPeriod;
    case v1::Trigger::TARGET_SCALE_PLUS:
    case v1::Trigger::TARGET_SCALE_MINUS:
      return v1::Trigger::kScalePulses;
    default:
      return v1::Trigger::INTERVAL_NOT_SET;
  }
}

Result<std::variant<Quantity, Duration>> to_interval(const v1::Trigger& trigger) {
  using Interval = std::variant<Quantity, Duration>;
  switch (trigger.interval_case()) {
    case v1::Trigger::kDistance:
      return to_quantity(trigger.distance()).map([](const Quantity& distance) { return Interval(distance); });
    case v1::Trigger::kPeriod:
      return Interval(to_duration(trigger.period()));
    case v1::Trigger::kScalePulses:
      return Interval(pulses(trigger.scale_pulses()));
    case v1::Trigger::INTERVAL_NOT_SET:
      break;
  }
  return Interval(pulses(0));
}

Result<api::TriggerWish> to_trigger(const v1::Trigger& trigger, const api::AxisNames& names) {
  if (trigger.target() < v1::Trigger::TARGET_NONE || trigger.target() > v1::Trigger::TARGET_SCALE_MINUS) {
    return fail(Reason::invalid_request, "the trigger has no target", "name one; TARGET_NONE ends it");
  }
  if (trigger.interval_case() != interval_of(trigger.target())) {
    return fail(Reason::invalid_request,
                fmt::format("{} has another kind of interval, or none", v1::Trigger::Target_Name(trigger.target())),
                "TARGET_DRIVE_PULSES needs `distance`, TARGET_TIMER `period`, and the scale targets `scale_pulses`");
  }
  const bool counts_pulses =
      trigger.target() != v1::Trigger::TARGET_NONE && trigger.target() != v1::Trigger::TARGET_TIMER;
  if (counts_pulses && trigger.axis().empty()) {
    return fail(Reason::invalid_request, "the trigger names no axis whose pulses it counts", "set `axis`");
  }
  api::TriggerWish wish{static_cast<stage::Trigger::Target>(trigger.target() - v1::Trigger::TARGET_NONE), 0, {}};
  if (!trigger.axis().empty()) {
    const Result<int> axis = names.find(trigger.axis());
    if (!axis) return tl::unexpected(axis.error());
    wish.axis = *axis;
  }
  const auto interval = to_interval(trigger);
  if (!interval) return tl::unexpected(interval.error());
  wish.interval = *interval;
  return wish;
}

Result<void> fill_controller(const v1::Settings& settings, const api::AxisNames& names, api::SettingsChange& change) {
  if (settings.has_display_lit()) change.display_lit = settings.display_lit();
  if (settings.has_beep()) change.beep = settings.beep();
  if (settings.has_settling_time()) change.settling = to_settling(settings.settling_time());
  if (settings.has_outputs()) {
    const Result<int> outputs = to_bits(settings.outputs());
    if (!outputs) return tl::unexpected(outputs.error());
    change.outputs = *outputs;
  }
  if (settings.has_sleeping()) change.sleeping = settings.sleeping();
  if (settings.mode() != v1::MODE_UNSPECIFIED) change.mode = to_text(settings.mode());
  if (settings.format() != v1::COMMAND_FORMAT_UNSPECIFIED) change.format = to_text(settings.format());
  change.inputs_given = settings.has_inputs();
  if (!settings.has_trigger()) return {};
  const Result<api::TriggerWish> trigger = to_trigger(settings.trigger(), names);
  if (!trigger) return tl::unexpected(trigger.error());
  change.trigger = *trigger;
  return {};
}

Result<api::NewCoordinate> to_coordinate(const v1::AxisCoordinate& coordinate, const api::AxisNames& names) {
  const Result<int> axis = names.find(coordinate.axis());
  if (!axis) return tl::unexpected(axis.error());
  api::NewCoordinate one{.axis = *axis};
  if (coordinate.set_origin()) one.coordinate = api::SetOrigin{};
  if (coordinate.unset_origin()) one.coordinate = api::UnsetOrigin{};
  if (coordinate.coordinate_case() != v1::AxisCoordinate::kPosition) return one;
  const auto quantity = to_quantity(coordinate.position());
  if (!quantity) return tl::unexpected(api::on_axis(*axis, quantity.error()));
  one.coordinate = *quantity;
  return one;
}

void fill_speeds(const stage::SpeedSetting& speeds, v1::Profile& profile) {
  profile.mutable_minimum()->set_pulses_per_s(speeds.minimum);
  profile.mutable_maximum()->set_pulses_per_s(speeds.maximum);
  *profile.mutable_acceleration_time() = to_proto(std::chrono::milliseconds(speeds.acceleration_ms));
}

void fill_axis(const stage::AxisSettings& settings, v1::AxisSettings& axis) {
  if (settings.speeds) fill_speeds(*settings.speeds, *axis.mutable_speeds());
  if (settings.origin_speeds) fill_speeds(*settings.origin_speeds, *axis.mutable_origin_speeds());
  if (settings.divisions) axis.set_divisions(*settings.divisions);
  if (settings.closed_loop) axis.set_closed_loop(*settings.closed_loop);
  if (settings.excited) axis.set_excited(*settings.excited);
  axis.set_name_on_device(settings.name_on_device);
  axis.set_scale_resolution(settings.scale_resolution);
}

}  // namespace

Result<api::SettingsChange> to_change(const v1::Settings& settings, const api::AxisNames& names) {
  api::SettingsChange change;
  for (const v1::AxisSettings& axis : settings.axes()) {
    Result<api::AxisChange> one = to_axis_change(axis, names);
    if (!one) return tl::unexpected(one.error());
    change.axes.push_back(*std::move(one));
  }
  if (const auto filled = fill_controller(settings, names, change); !filled) return tl::unexpected(filled.error());
  return change;
}

Result<api::NewCoordinates> to_coordinates(const v1::SetCoordinatesRequest& request, const api::AxisNames& names) {
  api::NewCoordinates all;
  for (const v1::AxisCoordinate& coordinate : request.coordinates()) {
    Result<api::NewCoordinate> one = to_coordinate(coordinate, names);
    if (!one) return tl::unexpected(one.error());
    all.push_back(*std::move(one));
  }
  return all;
}

v1::Settings to_proto(const stage::Settings& settings) {
  v1::Settings proto;
  for (const auto& [number, axis] : settings.axes) {
    v1::AxisSettings& one = *proto.add_axes();
    one.set_axis(std::to_string(number));
    fill_axis(axis, one);
  }
  if (settings.settling) *proto.mutable_settling_time() = to_proto(*settings.settling);
  if (settings.sleeping) proto.set_sleeping(*settings.sleeping);
  if (settings.display_lit) proto.set_display_lit(*settings.display_lit);
  if (settings.beep) proto.set_beep(*settings.beep);
  if (settings.outputs) *proto.mutable_outputs() = to_pins(*settings.outputs);
  if (settings.inputs) *proto.mutable_inputs() = to_pins(*settings.inputs);
  if (settings.trigger) fill_trigger(*settings.trigger, *proto.mutable_trigger());
  if (settings.mode) proto.set_mode(to_mode(*settings.mode));
  if (settings.format) proto.set_format(to_format(*settings.format));
  return proto;
}

}  // namespace axisgate::proto
