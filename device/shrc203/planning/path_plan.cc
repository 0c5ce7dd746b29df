#include "device/shrc203/planning/path_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "device/shrc203/planning/arc_lines.h"
#include "device/shrc203/planning/travel_time.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::int64_t kWayMax = 999'999'999;  // pulses (manual 84) KP:)
constexpr int kInputsMax = 63;                 // IN1 to IN6 (manual 95) I:)

Duration seconds(double value) { return std::chrono::nanoseconds(static_cast<std::int64_t>(value * 1e9)); }

struct Times {
  Duration shortest{}, longest{};
};

Times time_of_one_axis(double way, const SpeedSetting& speed) {
  return {travel_time(way, speed),
          seconds(way / static_cast<double>(speed.maximum)) + 2 * std::chrono::milliseconds(speed.acceleration_ms)};
}

double length_of(const std::vector<double>& ways) {
  double sum = 0;
  for (const double way : ways) sum += way * way;
  return std::sqrt(sum);
}

SpeedSetting known_speed(const State& state, int axis) {
  const auto& one = state.axis(axis);
  return {one.minimum_speed.value_or(1), one.maximum_speed.value_or(kSpeedMax), one.acceleration_ms.value_or(1000)};
}

tl::unexpected<Problem> in_segment(std::size_t index, Problem problem) {
  problem.message = fmt::format("segment {}: {}", index + 1, problem.message);
  return tl::unexpected(std::move(problem));
}

// Plans a path's segments in order, each from the end of the previous one.
class PathPlanner {
 public:
  PathPlanner(const Positions& from, const Envelope& envelope) : at_(from), envelope_(envelope) {
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) path_.begin[axis] = from[axis].value_or(0);
  }

  Result<void> add(const Segment& segment);
  PathPlan take() { return std::move(path_); }

 private:
  Result<SegmentPlan> plan_shape(const Segment& segment) const;
  Result<SegmentPlan> plan_straight(const Segment& segment) const;
  Result<void> check(const Segment& segment, const SegmentPlan& planned) const;
  Result<void> plan_speed(const Segment& segment, SegmentPlan& planned);
  Result<void> check_speeds(const SegmentPlan& planned, const std::vector<double>& ways) const;
  void plan_time(SegmentPlan& planned, const std::vector<double>& ways) const;
  std::vector<double> ways_of(const SegmentPlan& planned) const;
  double share_of(const SegmentPlan& planned, const std::vector<double>& ways, std::size_t place) const;

  std::int64_t slack() const { return path_.segments.empty() ? 0 : path_.segments.back().slack; }

  Positions at_;
  const Envelope& envelope_;
  SpeedSetting speed_{};  // present speeds of the first axis
  PathPlan path_;
};

// KP: accepts displacements only (manual 84)).
Result<SegmentPlan> PathPlanner::plan_straight(const Segment& segment) const {
  auto move = plan_move(segment.moves, segment.relative, at_, envelope_);
  if (!move) return tl::unexpected(move.error());
  for (auto& one : move->axes) {
    const auto& at = at_[static_cast<std::size_t>(one.axis - 1)];
    if (!at || !one.target) {
      return envelope_.position_unknown(one.axis);
    }
    for (const std::int64_t beside : {-slack(), slack()}) {
      if (auto good = envelope_.check_target(one.axis, *one.target + beside); !good) {
        return tl::unexpected(good.error());
      }
    }
    if (move->axes.size() == 1) continue;
    one.amount = *one.target - *at;
    if (std::abs(one.amount) > kWayMax) {
      return fail_on(one.axis, Reason::out_of_range,
                     fmt::format("{} would go {} pulses; {} are possible", envelope_.label(one.axis),
                                 std::abs(one.amount), kWayMax));
    }
  }
  if (move->axes.size() > 1) move->relative = true;
  SegmentPlan planned;
  planned.move = *std::move(move);
  return planned;
}

Result<SegmentPlan> PathPlanner::plan_shape(const Segment& segment) const {
  if (!segment.curve) return plan_straight(segment);
  auto curve = plan_curve(*segment.curve, segment.relative, at_, slack(), envelope_);
  if (!curve) return tl::unexpected(curve.error());
  SegmentPlan planned;
  planned.move = std::move(curve->move);
  planned.curve = std::move(curve->curve);
  return planned;
}

Result<void> PathPlanner::check(const Segment& segment, const SegmentPlan& planned) const {
  if (planned.move.set() != path_.axes) {
    return fail(Reason::invalid_request, "every segment of a path names the same axes",
                "repeat the axis with a distance of 0");
  }
  if (segment.rest < Duration{} || segment.rest > Segment::kRestMax) {
    return fail(Reason::out_of_range, "a rest before a segment lasts 0 to 255 s (manual 57) WT:)");
  }
  if (segment.inputs && (*segment.inputs < 0 || *segment.inputs > kInputsMax)) {
    return fail(Reason::out_of_range, fmt::format("inputs {}; IN1 to IN6 are 0 to {}", *segment.inputs, kInputsMax));
  }
  return check_scales(path_.axes, envelope_.state());
}

// The path speed is the lowest axis's S; the speed of a single axis is its F.
Result<void> PathPlanner::plan_speed(const Segment& segment, SegmentPlan& planned) {
  const int axis = path_.axes.lowest();
  auto own = planned.move.axes.front().speed;
  for (auto& one : planned.move.axes) one.speed.reset();
  if (segment.speed || segment.acceleration_ms) {
    const bool single = path_.axes.count() == 1;
    // A single axis runs at F, which may exceed the caller's limit.
    SpeedSetting speed = single ? own.value_or(speed_) : speed_;
    speed.acceleration_ms = segment.acceleration_ms.value_or(speed_.acceleration_ms);
    if (auto good = check_acceleration(axis, speed.acceleration_ms); !good) return good;
    if (segment.speed) {
      const auto asked = envelope_.speed(axis, *segment.speed);
      if (!asked) return tl::unexpected(asked.error());
      if (single) {
        speed.maximum = *asked;
        speed.minimum = std::min(speed_.minimum, *asked);
      } else {
        speed.minimum = *asked;
        speed.maximum = std::max(speed_.maximum, *asked);
      }
    }
    own = speed;
  }
  planned.move.axes.front().speed = own;
  if (own) speed_ = *own;
  return {};
}

std::vector<double> PathPlanner::ways_of(const SegmentPlan& planned) const {
  std::vector<double> ways;
  for (const auto& one : planned.move.axes) {
    ways.push_back(static_cast<double>(*one.target - *at_[static_cast<std::size_t>(one.axis - 1)]));
  }
  return ways;
}

// Returns the highest share of the path speed on this axis.
double PathPlanner::share_of(const SegmentPlan& planned, const std::vector<double>& ways, std::size_t place) const {
  if (planned.curve) return share_of_speed(planned.curve->arc, place == 2);
  return std::abs(ways[place]) / std::max(1.0, length_of(ways));
}

Result<void> PathPlanner::check_speeds(const SegmentPlan& planned, const std::vector<double>& ways) const {
  for (std::size_t place = 0; place < ways.size() && ways.size() > 1; ++place) {
    const double part = share_of(planned, ways, place) * static_cast<double>(speed_.minimum);
    const auto good = envelope_.check_speed(planned.move.axes[place].axis, static_cast<std::int64_t>(part));
    if (!good) return good;
  }
  return {};
}

// Computes the segment's duration: a line or curve runs at its lowest axis's S throughout (manual 71), 83)), and a
// single axis accelerates from S to F in R (manual 89)).
void PathPlanner::plan_time(SegmentPlan& planned, const std::vector<double>& ways) const {
  if (planned.curve) {
    planned.shortest = planned.longest = duration_of(planned.curve->arc, speed_.minimum);
  } else if (ways.size() > 1) {
    planned.shortest = planned.longest = seconds(length_of(ways) / static_cast<double>(speed_.minimum));
  } else {
    const auto [shortest, longest] = time_of_one_axis(length_of(ways), speed_);
    planned.shortest = shortest;
    planned.longest = longest;
  }
}

Result<void> PathPlanner::add(const Segment& segment) {
  auto planned = plan_shape(segment);
  if (!planned) return tl::unexpected(planned.error());
  const bool first = path_.segments.empty();
  if (first) {
    path_.axes = planned->move.set();
    speed_ = known_speed(envelope_.state(), path_.axes.lowest());
  }
  Result<void> good = check(segment, *planned);
  if (good) good = plan_speed(segment, *planned);
  if (!good) return good;
  const auto ways = ways_of(*planned);
  if (good = check_speeds(*planned, ways); !good) return good;
  if (!planned->curve && length_of(ways) == 0) {
    return fail(Reason::invalid_request, "it moves nothing", "leave it out");
  }
  plan_time(*planned, ways);
  for (const auto& one : planned->move.axes) at_[static_cast<std::size_t>(one.axis - 1)] = one.target;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) planned->end[axis] = at_[axis].value_or(0);
  planned->slack = slack() + (planned->curve ? slack_of(*planned->curve) : 0);
  planned->rest = segment.rest;
  planned->inputs = segment.inputs;
  path_.segments.push_back(*std::move(planned));
  return {};
}

}  // namespace

Register SegmentPlan::reg() const {
  if (curve) return Register::ep;
  if (move.axes.size() > 1 && move.relative) return Register::kp;
  return move.relative ? Register::mp : Register::ap;
}

Result<PathPlan> plan_path(const PathRequest& request, const Positions& from, const Envelope& envelope) {
  if (request.segments.empty() || request.segments.size() > PathRequest::kSegmentsMax) {
    return fail(Reason::invalid_request,
                fmt::format("a path has 1 to {} segments, not {}", PathRequest::kSegmentsMax, request.segments.size()));
  }
  PathPlanner planner(from, envelope);
  for (std::size_t index = 0; index < request.segments.size(); ++index) {
    if (auto good = planner.add(request.segments[index]); !good) return in_segment(index, good.error());
  }
  return planner.take();
}

void time_moves(PathPlan& path, const std::map<int, SpeedSetting>& known) {
  auto at = path.begin;
  for (SegmentPlan& segment : path.segments) {
    for (const auto& one : segment.move.axes) {
      const auto place = static_cast<std::size_t>(one.axis - 1);
      const auto own = known.find(one.axis);
      if (!one.speed && own == known.end()) continue;
      const auto way = static_cast<double>(std::abs(segment.end[place] - at[place]));
      const auto [shortest, longest] = time_of_one_axis(way, one.speed ? *one.speed : own->second);
      segment.shortest = std::max(segment.shortest, shortest);
      segment.longest = std::max(segment.longest, longest);
    }
    at = segment.end;
  }
}

}  // namespace axisgate::shrc203
