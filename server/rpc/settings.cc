#include "server/rpc/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "server/rpc/amounts.h"
#include "server/rpc/news.h"
#include "server/rpc/targets.h"

namespace axisgate::rpc {
namespace {

using stage::AxisSet;

// What leaves the state otherwise than a later line of the same request could count on.
bool stands_alone(const stage::Setting& setting) {
  return std::holds_alternative<stage::SetDivisions>(setting) || std::holds_alternative<stage::SetMode>(setting) ||
         std::holds_alternative<stage::SetFormat>(setting);
}

// The lines so far, or what is wrong with one.
class Change {
 public:
  // Both outlive this.
  Change(const stage::Kind& kind, const stage::State& state) : kind_(kind), state_(state) {}

  void add(const stage::Setting& setting) {
    if (problem_) return;
    Result<Lines> lines = kind_.lines_for(setting, state_);
    if (!lines) return refuse(std::move(lines.error()));
    std::ranges::move(*lines, std::back_inserter(lines_));
    alone_ = alone_ || stands_alone(setting);
  }
  void refuse(Problem problem) {
    if (!problem_) problem_ = std::move(problem);
  }
  Result<Lines> lines() {
    if (problem_) return tl::unexpected(*std::move(problem_));
    if (lines_.empty()) {
      return fail(Reason::invalid_request, "nothing is to be changed", "give a setting with its new value");
    }
    if (alone_ && lines_.size() > 1) {
      return fail(Reason::invalid_request, "divisions, mode and format are changed alone",
                  "ask for each by a call of its own");
    }
    return std::move(lines_);
  }

 private:
  const stage::Kind& kind_;
  const stage::State& state_;
  Lines lines_;
  bool alone_ = false;  // a line of theirs must have no other beside it
  std::optional<Problem> problem_;
};

void add_speeds(int number, const api::Profile& profile, const stage::AxisState& present, Change& change) {
  const auto pulses_of = [&](bool given, const api::Speed& speed) -> std::optional<std::int64_t> {
    if (!given) return {};
    const auto quantity = to_quantity(speed);
    const auto pulses = quantity ? to_pulses_per_second(*quantity, *present.scale) : tl::unexpected(quantity.error());
    if (!pulses) change.refuse(on_axis(number, pulses.error()));
    return pulses ? std::optional(*pulses) : std::nullopt;
  };
  stage::SetSpeeds speeds{.axis = number};
  speeds.minimum = pulses_of(profile.has_minimum(), profile.minimum());
  speeds.maximum = pulses_of(profile.has_maximum(), profile.maximum());
  if (profile.acceleration_ms() != 0) speeds.acceleration_ms = profile.acceleration_ms();
  change.add(speeds);
}

// They are set together: what is not given is sent as it is.
void add_origin_speeds(int number, const api::Profile& profile, const stage::AxisState& present, Change& change) {
  stage::AxisState origin = present;
  origin.minimum_speed.reset();
  origin.maximum_speed.reset();
  origin.acceleration_ms.reset();
  if (present.origin_speeds) {
    origin.minimum_speed = present.origin_speeds->minimum;
    origin.maximum_speed = present.origin_speeds->maximum;
    origin.acceleration_ms = present.origin_speeds->acceleration_ms;
  }
  const auto speeds = to_profile(profile, origin);
  if (!speeds) return change.refuse(on_axis(number, speeds.error()));
  const auto minimum = to_pulses_per_second(speeds->minimum, *present.scale),
             maximum = to_pulses_per_second(speeds->maximum, *present.scale);
  for (const auto& speed : {minimum, maximum}) {
    if (!speed) return change.refuse(on_axis(number, speed.error()));
  }
  change.add(stage::SetOriginSpeeds{number, {*minimum, *maximum, speeds->acceleration_ms}});
}

// Which it is, and that amounts can be converted there.
Result<int> usable_axis(int number, const stage::State& state) {
  const auto axis = to_axis(number);
  if (!axis) return axis;
  if (const auto good = controllable_axes(AxisSet::of(*axis), state); !good) return tl::unexpected(good.error());
  if (state.axis(*axis).scale) return axis;
  return fail(Reason::link_down, fmt::format("what a pulse of axis {} is has not been read yet", *axis),
              "try again when the device is up");
}

void add_axis(const api::AxisSettings& settings, const stage::State& state, Change& change) {
  const auto axis = usable_axis(settings.axis(), state);
  if (!axis) return change.refuse(axis.error());
  if (!settings.name_on_device().empty() || !settings.scale_resolution().empty()) {
    return change.refuse({.reason = Reason::invalid_request,
                          .message = "name_on_device and scale_resolution cannot be changed here",
                          .hint = "the controller's memory switches have them",
                          .axis = *axis});
  }
  const stage::AxisState& present = state.axis(*axis);
  if (settings.has_closed_loop()) change.add(stage::SetClosedLoop{*axis, settings.closed_loop()});
  if (settings.has_excited()) change.add(stage::SetExcitation{*axis, settings.excited()});
  if (settings.has_divisions()) change.add(stage::SetDivisions{*axis, settings.divisions()});
  if (settings.has_speeds()) add_speeds(*axis, settings.speeds(), present, change);
  if (settings.has_origin_speeds()) add_origin_speeds(*axis, settings.origin_speeds(), present, change);
}

// Below zero where it is no proper duration, and an hour where it is longer: either is out of range.
Duration to_duration(const google::protobuf::Duration& duration) {
  const bool proper = duration.seconds() >= 0 && duration.nanos() >= 0 && duration.nanos() < 1'000'000'000;
  if (!proper) return Duration(-1);
  return std::chrono::seconds(std::min<std::int64_t>(duration.seconds(), 3600)) + Duration(duration.nanos());
}

void add_trigger(const api::Trigger& trigger, Change& change) {
  if (trigger.target() < api::Trigger::TARGET_NONE || trigger.target() > api::Trigger::TARGET_SCALE_MINUS) {
    return change.refuse({.reason = Reason::invalid_request,
                          .message = "the trigger has no target",
                          .hint = "name one; TARGET_NONE ends it"});
  }
  const auto target = static_cast<stage::Trigger::Target>(trigger.target() - api::Trigger::TARGET_NONE);
  change.add(stage::SetTrigger{{target, trigger.axis(), trigger.interval()}});
}

void add_controller(const api::Settings& settings, Change& change) {
  if (settings.has_display_lit()) change.add(stage::SetDisplay{settings.display_lit()});
  if (settings.has_beep()) change.add(stage::SetBeep{settings.beep()});
  if (settings.has_settling()) change.add(stage::SetSettling{to_duration(settings.settling())});
  if (settings.has_outputs()) change.add(stage::SetOutputs{settings.outputs()});
  if (settings.has_trigger()) add_trigger(settings.trigger(), change);
  if (settings.has_sleeping()) change.add(stage::SetSleep{settings.sleeping()});
  if (settings.has_mode()) change.add(stage::SetMode{settings.mode()});
  if (settings.has_format()) change.add(stage::SetFormat{settings.format()});
  if (settings.has_inputs()) {
    change.refuse({.reason = Reason::invalid_request,
                   .message = "inputs are set by what is wired to them",
                   .hint = "leave them out"});
  }
}

}  // namespace

Result<Lines> lines_of(const api::ChangeSettingsRequest& request, const stage::Kind& kind, const stage::State& state) {
  Change change(kind, state);
  AxisSet axes;
  for (const api::AxisSettings& axis : request.settings().axes()) {
    add_axis(axis, state, change);
    const auto number = to_axis(axis.axis());
    if (number && axes.has(*number)) {
      change.refuse({.reason = Reason::invalid_request,
                     .message = fmt::format("axis {} is named twice", *number),
                     .hint = "name it once"});
    }
    if (number) axes.add(*number);
  }
  add_controller(request.settings(), change);
  return change.lines();
}

Result<Lines> lines_of(const api::SetCoordinatesRequest& request, const stage::Kind& kind, const stage::State& state) {
  AxisSet axes;
  std::map<int, std::int64_t> positions;
  std::optional<api::AxisCoordinate::CoordinateCase> way;
  for (const api::AxisCoordinate& one : request.coordinates()) {
    const auto axis = usable_axis(one.axis(), state);
    if (!axis) return tl::unexpected(axis.error());
    const bool meant =
        one.coordinate_case() == api::AxisCoordinate::kPosition || one.set_origin() || one.unset_origin();
    if (!meant) {
      return fail(Reason::invalid_request, fmt::format("axis {} has no coordinate", *axis),
                  "give `position`, or `set_origin` or `unset_origin` as true");
    }
    if (axes.has(*axis) || way.value_or(one.coordinate_case()) != one.coordinate_case()) {
      return fail(Reason::invalid_request, "each axis once, and all in the same way",
                  "ask for the others by a second call");
    }
    axes.add(*axis);
    way = one.coordinate_case();
    if (way != api::AxisCoordinate::kPosition) continue;
    const auto quantity = to_quantity(one.position());
    if (!quantity) return tl::unexpected(on_axis(*axis, quantity.error()));
    const auto pulses = to_pulses(*quantity, *state.axis(*axis).scale);
    if (!pulses) return tl::unexpected(on_axis(*axis, pulses.error()));
    positions[*axis] = *pulses;
  }
  if (way == api::AxisCoordinate::kSetOrigin) return kind.lines_for(stage::SetOrigin{axes}, state);
  if (way == api::AxisCoordinate::kUnsetOrigin) return kind.lines_for(stage::UnsetOrigin{axes}, state);
  if (way == api::AxisCoordinate::kPosition) return kind.lines_for(stage::SetCoordinates{positions}, state);
  return fail(Reason::invalid_request, "no coordinate is given", "name axes, and what their places shall be called");
}

stage::Settings known_settings(const stage::State& state) {
  return {.outputs = state.outputs, .trigger = state.trigger};
}

namespace {

void fill_speeds(const stage::SpeedSetting& speeds, api::Profile& profile) {
  profile.mutable_minimum()->set_pulses_per_s(speeds.minimum);
  profile.mutable_maximum()->set_pulses_per_s(speeds.maximum);
  profile.set_acceleration_ms(speeds.acceleration_ms);
}

void fill_axis(const stage::AxisSettings& settings, api::AxisSettings& axis) {
  if (settings.speeds) fill_speeds(*settings.speeds, *axis.mutable_speeds());
  if (settings.origin_speeds) fill_speeds(*settings.origin_speeds, *axis.mutable_origin_speeds());
  if (settings.divisions) axis.set_divisions(*settings.divisions);
  if (settings.closed_loop) axis.set_closed_loop(*settings.closed_loop);
  if (settings.excited) axis.set_excited(*settings.excited);
  axis.set_name_on_device(settings.name_on_device);
  axis.set_scale_resolution(settings.scale_resolution);
}

}  // namespace

api::Settings to_proto(const stage::Settings& settings) {
  api::Settings proto;
  for (const auto& [number, axis] : settings.axes) {
    api::AxisSettings& one = *proto.add_axes();
    one.set_axis(number);
    fill_axis(axis, one);
  }
  if (settings.settling) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(*settings.settling);
    proto.mutable_settling()->set_seconds(seconds.count());
    proto.mutable_settling()->set_nanos(static_cast<std::int32_t>((*settings.settling - seconds).count()));
  }
  if (settings.sleeping) proto.set_sleeping(*settings.sleeping);
  if (settings.display_lit) proto.set_display_lit(*settings.display_lit);
  if (settings.beep) proto.set_beep(*settings.beep);
  if (settings.outputs) proto.set_outputs(*settings.outputs);
  if (settings.inputs) proto.set_inputs(*settings.inputs);
  if (settings.trigger) fill_trigger(*settings.trigger, *proto.mutable_trigger());
  if (settings.mode) proto.set_mode(*settings.mode);
  if (settings.format) proto.set_format(*settings.format);
  return proto;
}

}  // namespace axisgate::rpc
