// A path in pulses, checked against units, travel and speed limits before anything is sent: straight lines, curves and
// moves of one axis, with pauses between them.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/command/trigger.h"
#include "device/shrc203/planning/curve_plan.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

struct SegmentPlan {
  MovePlan move;  // for a curve: its end; for lines and curves the speeds are those of the first axis
  std::optional<CurvePlan> curve{};
  std::array<std::int64_t, kAxisCount> end{};  // position of each axis after the segment
  std::int64_t slack = 0;                      // pulses by which the end computed by the controller may differ
  Duration shortest{};                         // shortest possible duration at its speeds
  Duration longest{};                          // longest expected duration, without settling
  // Conditions before the segment starts. If any is set, the segment is sent only when the axes are stationary.
  bool from_rest = false;
  Duration rest{};
  std::optional<int> inputs{};
  std::optional<Trigger> arm{};

  bool waits() const { return from_rest || rest > Duration{} || inputs || arm; }
  Register reg() const;  // prebuffer register to which the segment is written
};

struct PathPlan {
  AxisSet axes;
  std::array<std::int64_t, kAxisCount> begin{};  // position of each axis before the path
  std::vector<SegmentPlan> segments;
};

// Plans a path. Fails as plan_move() and plan_curve() do, and if the segments have different axes, the axes of a line
// or curve have different scales, a segment has no length, or a pause or input pattern is out of range. `from` must
// know every axis of the path.
Result<PathPlan> plan_path(const PathRequest& request, const Positions& from, const Envelope& envelope);

// Computes the durations of segments whose axes each run at their own speed: the move's speed if set, else the `known`
// one.
void time_moves(PathPlan& path, const std::map<int, SpeedSetting>& known);

}  // namespace axisgate::shrc203
