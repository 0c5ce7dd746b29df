// What a path comes to in pulses, checked against units, travel and speed limits before anything is sent: straight
// lines, curves, and one axis's moves, with rests between.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/command/trigger.h"
#include "device/shrc203/planning/curve_plan.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/stage.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

struct SegmentPlan {
  MovePlan move;  // of a curve: where it leads; of a line and a curve the speeds are the first axis's
  std::optional<CurvePlan> curve{};
  std::array<std::int64_t, kAxisCount> end{};  // where each axis stands after it
  std::int64_t slack = 0;                      // pulses by which the end that the controller computes may differ
  Duration shortest{};                         // by its speeds; it cannot be over sooner
  Duration longest{};                          // it should be over by then, settling aside
  // What must be before it starts. Any of them: the axes stand, and nothing was put into the prebuffer.
  bool from_rest = false;
  Duration rest{};
  std::optional<int> inputs{};
  std::optional<Trigger> arm{};

  bool waits() const { return from_rest || rest > Duration{} || inputs || arm; }
  Register reg() const;  // the prebuffer that it is put into
};

struct PathPlan {
  AxisSet axes;
  std::array<std::int64_t, kAxisCount> begin{};  // where each axis stands before it
  std::vector<SegmentPlan> segments;
};

// As plan_move and plan_curve, and: the same axes in every segment, lines and curves of axes of one scale, no segment
// without any way, rests and inputs within their ranges. Every axis of the path must be known in `from`.
Result<PathPlan> plan_path(const PathRequest& request, const Positions& from, const Envelope& envelope);

// The times of segments whose axes each run at their own speeds: those of the move, else the known ones.
void time_moves(PathPlan& path, const std::map<int, SpeedSetting>& known);

}  // namespace axisgate::shrc203
