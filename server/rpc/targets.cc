#include "server/rpc/targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/rpc/amounts.h"
#include "server/rpc/curves.h"

namespace axisgate::rpc {

Problem on_axis(int axis, Problem problem) {
  problem.message = fmt::format("axis {}: {}", axis, problem.message);
  problem.axis = axis;
  return problem;
}

namespace {

tl::unexpected<Problem> profile_needs(std::string_view what) {
  return fail(Reason::invalid_request, fmt::format("the axis's present {} is not known yet", what),
              "give minimum, maximum and acceleration_ms, or ask again once the device's link is up");
}

// Manual 89) D:, S <= F: an axis's present S may lie above a new, lower F, which it then is lowered to.
Result<Quantity> minimum_under(const Quantity& maximum, const stage::AxisState& axis) {
  if (!axis.minimum_speed) return profile_needs("minimum speed S");
  if (maximum.unit != Unit::pulses && !axis.scale) return profile_needs("scale");
  const Result<std::int64_t> highest = to_pulses_per_second(maximum, axis.scale.value_or(Scale{}));
  if (!highest) return tl::unexpected(highest.error());
  return pulses(std::min(*axis.minimum_speed, *highest));
}

}  // namespace

Result<stage::SpeedProfile> to_profile(const api::Profile& profile, const stage::AxisState& axis) {
  stage::SpeedProfile speeds;
  if (profile.has_maximum()) {
    const Result<Quantity> maximum = to_quantity(profile.maximum());
    if (!maximum) return tl::unexpected(maximum.error());
    speeds.maximum = *maximum;
  } else {
    if (!axis.maximum_speed) return profile_needs("maximum speed F");
    speeds.maximum = pulses(*axis.maximum_speed);
  }
  const Result<Quantity> minimum =
      profile.has_minimum() ? to_quantity(profile.minimum()) : minimum_under(speeds.maximum, axis);
  if (!minimum) return tl::unexpected(minimum.error());
  speeds.minimum = *minimum;
  if (profile.acceleration_ms() == 0 && !axis.acceleration_ms) return profile_needs("acceleration time R");
  speeds.acceleration_ms = profile.acceleration_ms() != 0 ? profile.acceleration_ms() : *axis.acceleration_ms;
  return speeds;
}

namespace {

constexpr int kInputsMax = 63;  // IN1 to IN6 (manual 95) I:)

Result<stage::AxisMove> to_axis_move(int number, const api::Distance& distance) {
  const Result<int> axis = to_axis(number);
  if (!axis) return tl::unexpected(axis.error());
  const Result<Quantity> quantity = to_quantity(distance);
  if (!quantity) return tl::unexpected(on_axis(*axis, quantity.error()));
  return stage::AxisMove{*axis, *quantity, std::nullopt};
}

Result<std::vector<stage::AxisMove>> to_axis_moves(const api::Segment& segment) {
  std::vector<stage::AxisMove> moves;
  const auto add = [&](const api::AxisDistance& part) -> Result<void> {
    Result<stage::AxisMove> move = to_axis_move(part.axis(), part.distance());
    if (!move) return tl::unexpected(move.error());
    moves.push_back(*std::move(move));
    return {};
  };
  switch (segment.shape_case()) {
    case api::Segment::kSingle:
      if (const Result<void> added = add(segment.single()); !added) return tl::unexpected(added.error());
      return moves;
    case api::Segment::kLine:
      if (segment.line().distances_size() < 2) {
        return fail(Reason::invalid_request, "a line moves two or three axes", "use `single` for one axis");
      }
      for (const api::AxisDistance& part : segment.line().distances()) {
        if (const Result<void> added = add(part); !added) return tl::unexpected(added.error());
      }
      return moves;
    case api::Segment::kArc:
    case api::Segment::SHAPE_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "the segment has no shape", "set `line`, `single` or `arc`");
}

// What goes before a segment, while the axes stand.
Result<void> fill_halt(const api::Segment& segment, stage::Segment& stretch) {
  constexpr auto most = std::chrono::duration_cast<std::chrono::milliseconds>(stage::Segment::kRestMax).count();
  if (segment.rest_ms() < 0 || segment.rest_ms() > most) {
    return fail(Reason::out_of_range, fmt::format("a rest of {} ms; 0 to {} ms are possible", segment.rest_ms(), most));
  }
  stretch.rest = std::chrono::milliseconds(segment.rest_ms());
  if (!segment.has_inputs()) return {};
  if (segment.inputs() < 0 || segment.inputs() > kInputsMax) {
    return fail(Reason::out_of_range,
                fmt::format("inputs that show {}; 0 to {} are possible", segment.inputs(), kInputsMax),
                "add 1 for IN1, 2 for IN2, 4 for IN3, 8 for IN4, 16 for IN5 and 32 for IN6");
  }
  stretch.inputs = segment.inputs();
  return {};
}

Result<Quantity> to_approach(const api::Distance& way) {
  const Result<Quantity> approach = to_quantity(way);
  if (!approach || approach->value.digits != 0) return approach;
  return fail(Reason::invalid_request, "an approach of 0 comes from no side", "leave it out to go straight there");
}

}  // namespace

Result<stage::MoveRequest> to_move(const api::MoveRequest& request, const stage::State& state,
                                   stage::RequestContext context) {
  stage::MoveRequest move;
  move.relative = request.relative();
  move.context = std::move(context);
  for (const api::AxisTarget& target : request.targets()) {
    Result<stage::AxisMove> one = to_axis_move(target.axis(), target.distance());
    if (!one) return tl::unexpected(one.error());
    if (target.has_profile()) {
      const Result<stage::SpeedProfile> profile = to_profile(target.profile(), state.axis(target.axis()));
      if (!profile) return tl::unexpected(on_axis(target.axis(), profile.error()));
      one->profile = *profile;
    }
    if (target.has_approach()) {
      const Result<Quantity> approach = to_approach(target.approach());
      if (!approach) return tl::unexpected(on_axis(target.axis(), approach.error()));
      one->approach = *approach;
    }
    move.moves.push_back(*std::move(one));
  }
  return move;
}

Result<stage::Segment> to_segment(const api::Segment& segment) {
  stage::Segment stretch;
  if (segment.has_arc()) {
    Result<stage::Curve> curve = to_curve(segment.arc());
    if (!curve) return tl::unexpected(curve.error());
    stretch.curve = *std::move(curve);
  } else {
    Result<std::vector<stage::AxisMove>> moves = to_axis_moves(segment);
    if (!moves) return tl::unexpected(moves.error());
    stretch.moves = *std::move(moves);
  }
  stretch.relative = segment.relative();
  if (segment.has_speed()) {
    const Result<Quantity> speed = to_quantity(segment.speed());
    if (!speed) return tl::unexpected(speed.error());
    stretch.speed = *speed;
  }
  if (segment.acceleration_ms() != 0) stretch.acceleration_ms = segment.acceleration_ms();
  const Result<void> halted = fill_halt(segment, stretch);
  if (!halted) return tl::unexpected(halted.error());
  return stretch;
}

Result<stage::ScanRequest> to_scan(const api::ScanRequest& request, stage::RequestContext context) {
  const Result<int> axis = to_axis(request.axis());
  if (!axis) return tl::unexpected(axis.error());
  stage::ScanRequest scan;
  scan.axis = *axis;
  scan.context = std::move(context);
  for (const auto& [end, place] : {std::pair(&request.from(), &scan.from), {&request.to(), &scan.to}}) {
    const Result<Quantity> quantity = to_quantity(*end);
    if (!quantity) return tl::unexpected(on_axis(*axis, quantity.error()));
    *place = *quantity;
  }
  if (request.has_speed()) {
    const Result<Quantity> speed = to_quantity(request.speed());
    if (!speed) return tl::unexpected(on_axis(*axis, speed.error()));
    scan.speed = *speed;
  }
  if (request.acceleration_ms() != 0) scan.acceleration_ms = request.acceleration_ms();
  switch (request.interval_case()) {
    case api::ScanRequest::kDrivePulses:
      scan.interval = request.drive_pulses();
      return scan;
    case api::ScanRequest::kScalePulses:
      scan.by_scale = true;
      scan.interval = request.scale_pulses();
      return scan;
    case api::ScanRequest::INTERVAL_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "a scan does not say how far apart its trigger pulses are",
              "set `drive_pulses` or `scale_pulses`");
}

Result<stage::AxisSet> controllable_axes(stage::AxisSet named, const stage::State& state) {
  const stage::AxisSet controllable = state.controllable();
  if (controllable.empty()) {
    return fail(Reason::link_down, state.link_problem.empty() ? "the device has not told yet which axes it has"
                                                              : "the device cannot be asked: " + state.link_problem);
  }
  if (named.empty()) return controllable;
  if (controllable.contains(named)) return named;
  const stage::AxisSet missing = named - controllable;
  return fail(Reason::unknown_axis, fmt::format("{} cannot be moved here", to_string(missing)),
              fmt::format("the controller is set to {} (?:AXIS)", to_string(controllable)));
}

}  // namespace axisgate::rpc
