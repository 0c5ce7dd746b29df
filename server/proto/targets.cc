#include "server/proto/targets.h"

#include <chrono>
#include <utility>

#include "server/proto/amounts.h"
#include "server/proto/curves.h"

namespace axisgate::proto {
namespace {

using api::AxisNames;
using api::on_axis;

Result<stage::AxisMove> to_axis_move(const v1::AxisDistance& part, const AxisNames& names) {
  const Result<int> axis = names.find(part.axis());
  if (!axis) return tl::unexpected(axis.error());
  const Result<Quantity> quantity = to_quantity(part.distance());
  if (!quantity) return tl::unexpected(on_axis(*axis, quantity.error()));
  return stage::AxisMove{*axis, *quantity, std::nullopt};
}

Result<std::vector<stage::AxisMove>> to_axis_moves(const v1::Segment& segment, const AxisNames& names) {
  std::vector<stage::AxisMove> moves;
  const auto add = [&](const v1::AxisDistance& part) -> Result<void> {
    Result<stage::AxisMove> move = to_axis_move(part, names);
    if (!move) return tl::unexpected(move.error());
    moves.push_back(*std::move(move));
    return {};
  };
  switch (segment.shape_case()) {
    case v1::Segment::kSingle:
      if (const Result<void> added = add(segment.single()); !added) return tl::unexpected(added.error());
      return moves;
    case v1::Segment::kLine:
      if (segment.line().distances_size() < 2) {
        return fail(Reason::invalid_request, "a line moves at least two axes", "use `single` for one axis");
      }
      for (const v1::AxisDistance& part : segment.line().distances()) {
        if (const Result<void> added = add(part); !added) return tl::unexpected(added.error());
      }
      return moves;
    case v1::Segment::kArc:
    case v1::Segment::SHAPE_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "the segment has no shape", "set `line`, `single` or `arc`");
}

Result<api::AxisTarget> to_target(const v1::AxisTarget& target, const AxisNames& names) {
  const Result<int> axis = names.find(target.axis());
  if (!axis) return tl::unexpected(axis.error());
  const Result<Quantity> distance = to_quantity(target.distance());
  if (!distance) return tl::unexpected(on_axis(*axis, distance.error()));
  api::AxisTarget one{.axis = *axis, .distance = *distance};
  if (target.has_profile()) {
    const Result<api::Speeds> speeds = to_speeds(target.profile());
    if (!speeds) return tl::unexpected(on_axis(*axis, speeds.error()));
    one.speeds = *speeds;
  }
  if (target.has_approach()) {
    const Result<Quantity> approach = to_quantity(target.approach());
    if (!approach) return tl::unexpected(on_axis(*axis, approach.error()));
    one.approach = *approach;
  }
  return one;
}

std::optional<int> to_direction(v1::AxisJog::Direction direction) {
  if (direction == v1::AxisJog::DIRECTION_PLUS) return 1;
  if (direction == v1::AxisJog::DIRECTION_MINUS) return -1;
  return std::nullopt;
}

}  // namespace

Result<api::Speeds> to_speeds(const v1::Profile& profile) {
  api::Speeds speeds;
  if (profile.has_maximum()) {
    const Result<Quantity> maximum = to_quantity(profile.maximum());
    if (!maximum) return tl::unexpected(maximum.error());
    speeds.maximum = *maximum;
  }
  if (profile.has_minimum()) {
    const Result<Quantity> minimum = to_quantity(profile.minimum());
    if (!minimum) return tl::unexpected(minimum.error());
    speeds.minimum = *minimum;
  }
  if (profile.has_acceleration_time()) {
    const Result<int> time = to_milliseconds(profile.acceleration_time());
    if (!time) return tl::unexpected(time.error());
    speeds.acceleration_ms = *time;
  }
  return speeds;
}

Result<api::Move> to_move(const v1::MoveRequest& request, const AxisNames& names) {
  api::Move move{.targets = {}, .relative = request.relative()};
  for (const v1::AxisTarget& target : request.targets()) {
    Result<api::AxisTarget> one = to_target(target, names);
    if (!one) return tl::unexpected(one.error());
    move.targets.push_back(*std::move(one));
  }
  return move;
}

Result<stage::Segment> to_segment(const v1::Segment& segment, const AxisNames& names) {
  stage::Segment stretch;
  if (segment.has_arc()) {
    Result<stage::Curve> curve = to_curve(segment.arc(), names);
    if (!curve) return tl::unexpected(curve.error());
    stretch.curve = *std::move(curve);
  } else {
    Result<std::vector<stage::AxisMove>> moves = to_axis_moves(segment, names);
    if (!moves) return tl::unexpected(moves.error());
    stretch.moves = *std::move(moves);
  }
  stretch.relative = segment.relative();
  if (segment.has_speed()) {
    const Result<Quantity> speed = to_quantity(segment.speed());
    if (!speed) return tl::unexpected(speed.error());
    stretch.speed = *speed;
  }
  if (segment.has_acceleration_time()) {
    const Result<int> time = to_milliseconds(segment.acceleration_time());
    if (!time) return tl::unexpected(time.error());
    stretch.acceleration_ms = *time;
  }
  if (segment.has_rest_time()) {
    const Result<int> time = to_milliseconds(segment.rest_time());
    if (!time) return tl::unexpected(time.error());
    stretch.rest = std::chrono::milliseconds(*time);
  }
  if (segment.has_inputs()) {
    const Result<int> inputs = to_bits(segment.inputs());
    if (!inputs) return tl::unexpected(inputs.error());
    stretch.inputs = *inputs;
  }
  return stretch;
}

Result<api::Scan> to_scan(const v1::ScanRequest& request, const AxisNames& names) {
  const Result<int> axis = names.find(request.axis());
  if (!axis) return tl::unexpected(axis.error());
  api::Scan wanted;
  stage::ScanRequest& scan = wanted.request;
  scan.axis = *axis;
  for (const auto& [end, place] : {std::pair(&request.start(), &scan.from), {&request.end(), &scan.to}}) {
    const Result<Quantity> quantity = to_quantity(*end);
    if (!quantity) return tl::unexpected(on_axis(*axis, quantity.error()));
    *place = *quantity;
  }
  if (request.has_speed()) {
    const Result<Quantity> speed = to_quantity(request.speed());
    if (!speed) return tl::unexpected(on_axis(*axis, speed.error()));
    scan.speed = *speed;
  }
  if (request.has_acceleration_time()) {
    const Result<int> time = to_milliseconds(request.acceleration_time());
    if (!time) return tl::unexpected(on_axis(*axis, time.error()));
    scan.acceleration_ms = *time;
  }
  switch (request.interval_case()) {
    case v1::ScanRequest::kDistance: {
      const Result<Quantity> distance = to_quantity(request.distance());
      if (!distance) return tl::unexpected(on_axis(*axis, distance.error()));
      wanted.interval = *distance;
      return wanted;
    }
    case v1::ScanRequest::kScalePulses:
      scan.by_scale = true;
      wanted.interval = pulses(request.scale_pulses());
      return wanted;
    case v1::ScanRequest::INTERVAL_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "a scan does not say how far apart its trigger pulses are",
              "set `distance` or `scale_pulses`");
}

Result<std::vector<api::JogAxis>> to_jog_axes(const google::protobuf::RepeatedPtrField<v1::AxisJog>& jogs,
                                              const AxisNames& names) {
  std::vector<api::JogAxis> axes;
  for (const v1::AxisJog& one : jogs) {
    const Result<int> axis = names.find(one.axis());
    if (!axis) return tl::unexpected(axis.error());
    axes.push_back({.axis = *axis, .direction = to_direction(one.direction())});
    if (!one.has_speed()) continue;
    const Result<Quantity> speed = to_quantity(one.speed());
    if (!speed) return tl::unexpected(speed.error());
    axes.back().speed = *speed;
  }
  return axes;
}

}  // namespace axisgate::proto
