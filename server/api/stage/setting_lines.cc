#include "server/api/stage/setting_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <ratio>
#include <utility>

namespace axisgate::api {
namespace {

using stage::AxisSet;

// Reports whether a setting changes the state on which later lines of the same request would rely.
bool must_be_alone(const stage::Setting& setting) {
  return std::holds_alternative<stage::SetDivisions>(setting) || std::holds_alternative<stage::SetMode>(setting) ||
         std::holds_alternative<stage::SetFormat>(setting);
}

// A Change collects lines, or the first problem.
class Change {
 public:
  // The referenced objects must outlive this one.
  Change(const stage::Kind& kind, const stage::State& state) : kind_(kind), state_(state) {}

  void add(const stage::Setting& setting) {
    if (problem_) return;
    Result<Lines> lines = kind_.lines_for(setting, state_);
    if (!lines) return refuse(std::move(lines.error()));
    std::ranges::move(*lines, std::back_inserter(lines_));
    alone_ = alone_ || must_be_alone(setting);
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
                  "change each by a call of its own");
    }
    return std::move(lines_);
  }

 private:
  const stage::Kind& kind_;
  const stage::State& state_;
  Lines lines_;
  bool alone_ = false;  // a line must be the only one of its request
  std::optional<Problem> problem_;
};

void add_speeds(int axis, const Speeds& speeds, const stage::AxisState& present, Change& change) {
  const auto pulses_of = [&](const std::optional<Quantity>& speed) -> std::optional<std::int64_t> {
    if (!speed) return {};
    const auto pulses = to_pulses_per_second(*speed, *present.scale);
    if (!pulses) change.refuse(on_axis(axis, pulses.error()));
    return pulses ? std::optional(*pulses) : std::nullopt;
  };
  stage::SetSpeeds set{.axis = axis};
  set.minimum = pulses_of(speeds.minimum);
  set.maximum = pulses_of(speeds.maximum);
  set.acceleration_ms = speeds.acceleration_ms;
  change.add(set);
}

// Sets all three values together: those that are not given are sent with their present values.
void add_origin_speeds(int axis, const Speeds& speeds, const stage::AxisState& present, Change& change) {
  stage::AxisState origin = present;
  origin.minimum_speed.reset();
  origin.maximum_speed.reset();
  origin.acceleration_ms.reset();
  if (present.origin_speeds) {
    origin.minimum_speed = present.origin_speeds->minimum;
    origin.maximum_speed = present.origin_speeds->maximum;
    origin.acceleration_ms = present.origin_speeds->acceleration_ms;
  }
  const auto all = completed(speeds, origin);
  if (!all) return change.refuse(on_axis(axis, all.error()));
  const auto minimum = to_pulses_per_second(all->minimum, *present.scale),
             maximum = to_pulses_per_second(all->maximum, *present.scale);
  for (const auto& speed : {minimum, maximum}) {
    if (!speed) return change.refuse(on_axis(axis, speed.error()));
  }
  change.add(stage::SetOriginSpeeds{axis, {*minimum, *maximum, all->acceleration_ms}});
}

// Returns the axis if it is controllable, and amounts can be converted for it.
Result<int> usable_axis(int number, const stage::State& state) {
  if (const auto good = controllable_axes(AxisSet::of(number), state); !good) return tl::unexpected(good.error());
  if (state.axis(number).scale) return number;
  return fail(Reason::link_down, fmt::format("the resolution of axis {} is not known yet", number),
              "try again when the device is up");
}

void add_axis(const AxisChange& axis_change, const stage::State& state, Change& change) {
  const auto axis = usable_axis(axis_change.axis, state);
  if (!axis) return change.refuse(axis.error());
  if (axis_change.names_given) {
    return change.refuse({.reason = Reason::invalid_request,
                          .message = "name_on_device and scale_resolution cannot be changed here",
                          .hint = "the controller's memory switches have them",
                          .axis = *axis});
  }
  const stage::AxisState& present = state.axis(*axis);
  if (axis_change.closed_loop) change.add(stage::SetClosedLoop{*axis, *axis_change.closed_loop});
  if (axis_change.excited) change.add(stage::SetExcitation{*axis, *axis_change.excited});
  if (axis_change.divisions) change.add(stage::SetDivisions{*axis, *axis_change.divisions});
  if (axis_change.speeds) add_speeds(*axis, *axis_change.speeds, present, change);
  if (axis_change.origin_speeds) add_origin_speeds(*axis, *axis_change.origin_speeds, present, change);
}

Result<std::int64_t> to_hundredths(Duration period) {
  using Hundredths = std::chrono::duration<std::int64_t, std::centi>;
  if (period <= Duration::zero()) {
    return fail(Reason::out_of_range, "the period of the trigger is not above 0", "0.01 s to 100 s are possible");
  }
  const auto whole = std::chrono::floor<Hundredths>(period);
  if (whole == period) return whole.count();
  return fail(Reason::not_representable,
              fmt::format("a period of {} is not a whole number of 0.01 s", for_people(period)));
}

void add_trigger(const TriggerWish& wish, const stage::State& state, Change& change) {
  stage::Trigger trigger{wish.target, wish.axis, 0};
  if (wish.axis != 0) {
    if (const auto good = controllable_axes(AxisSet::of(wish.axis), state); !good) return change.refuse(good.error());
  }
  const auto* period = std::get_if<Duration>(&wish.interval);
  const Result<std::int64_t> interval =
      period != nullptr ? to_hundredths(*period)
                        : to_drive_pulses(std::get<Quantity>(wish.interval), std::max(wish.axis, 1), state);
  if (!interval) return change.refuse(interval.error());
  trigger.interval = *interval;
  change.add(stage::SetTrigger{trigger});
}

void add_controller(const SettingsChange& wanted, const stage::State& state, Change& change) {
  if (wanted.display_lit) change.add(stage::SetDisplay{*wanted.display_lit});
  if (wanted.beep) change.add(stage::SetBeep{*wanted.beep});
  if (wanted.settling) change.add(stage::SetSettling{*wanted.settling});
  if (wanted.outputs) change.add(stage::SetOutputs{*wanted.outputs});
  if (wanted.trigger) add_trigger(*wanted.trigger, state, change);
  if (wanted.sleeping) change.add(stage::SetSleep{*wanted.sleeping});
  if (wanted.mode) change.add(stage::SetMode{*wanted.mode});
  if (wanted.format) change.add(stage::SetFormat{*wanted.format});
  if (wanted.inputs_given) {
    change.refuse({.reason = Reason::invalid_request,
                   .message = "inputs are set by what is wired to them",
                   .hint = "leave them out"});
  }
}

// Coordinates collects the new coordinates, axis by axis.
struct Coordinates {
  AxisSet axes{};
  std::optional<std::size_t> way{};  // alternative of NewCoordinate::coordinate that all axes have
  std::map<int, std::int64_t> positions{};

  Result<void> add(const NewCoordinate& one, const stage::State& state) {
    const auto axis = usable_axis(one.axis, state);
    if (!axis) return tl::unexpected(axis.error());
    if (!one.coordinate) {
      return fail(Reason::invalid_request, fmt::format("axis {} has no coordinate", *axis),
                  "give `position`, or `set_origin` or `unset_origin` as true");
    }
    if (axes.has(*axis) || way.value_or(one.coordinate->index()) != one.coordinate->index()) {
      return fail(Reason::invalid_request, "each axis once, and all in the same way",
                  "ask by a second call for the others");
    }
    axes.add(*axis);
    way = one.coordinate->index();
    const auto* position = std::get_if<Quantity>(&*one.coordinate);
    if (position == nullptr) return {};
    const auto pulses = to_pulses(*position, *state.axis(*axis).scale);
    if (!pulses) return tl::unexpected(on_axis(*axis, pulses.error()));
    positions[*axis] = *pulses;
    return {};
  }
};

}  // namespace

Result<Lines> lines_of(const SettingsChange& wanted, const stage::Kind& kind, const stage::State& state) {
  Change change(kind, state);
  AxisSet axes;
  for (const AxisChange& axis : wanted.axes) {
    add_axis(axis, state, change);
    if (axes.has(axis.axis)) {
      change.refuse({.reason = Reason::invalid_request,
                     .message = fmt::format("axis {} is named twice", axis.axis),
                     .hint = "name it once"});
    }
    axes.add(axis.axis);
  }
  add_controller(wanted, state, change);
  return change.lines();
}

Result<Lines> lines_of(const NewCoordinates& coordinates, const stage::Kind& kind, const stage::State& state) {
  if (coordinates.empty()) {
    return fail(Reason::invalid_request, "no coordinate is given", "name axes and their new coordinates");
  }
  Coordinates all;
  for (const NewCoordinate& one : coordinates) {
    if (const auto added = all.add(one, state); !added) return tl::unexpected(added.error());
  }
  const auto& first = *coordinates.front().coordinate;
  if (std::holds_alternative<SetOrigin>(first)) return kind.lines_for(stage::SetOrigin{all.axes}, state);
  if (std::holds_alternative<UnsetOrigin>(first)) return kind.lines_for(stage::UnsetOrigin{all.axes}, state);
  return kind.lines_for(stage::SetCoordinates{all.positions}, state);
}

}  // namespace axisgate::api
