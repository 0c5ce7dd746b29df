// What a request comes to in pulses, checked against units, travel and speed limits before anything is sent.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/controller.h"
#include "device/shrc203/envelope.h"
#include "device/shrc203/reply.h"
#include "device/shrc203/state.h"

namespace axisgate::shrc203 {

struct AxisPlan {
  int axis = 0;
  std::int64_t amount = 0;             // as sent: a way or a target
  std::optional<std::int64_t> target;  // nothing where a relative move's start is not known
  std::optional<SpeedSetting> speed;   // to be sent with the move
};

struct MovePlan {
  bool relative = false;
  std::vector<AxisPlan> axes;  // ascending
  AxisSet set() const;
};

// The speeds to be sent with it, by axis.
std::map<int, SpeedSetting> speeds_of(const MovePlan& plan);

// Where the axes stand when the motion begins; nothing for an axis that nobody knows.
using Positions = std::array<std::optional<std::int64_t>, kAxisCount>;
Positions positions_of(const State& state);

// What the envelope refuses, not_representable, out_of_range, invalid_request. Where `from` does not know an axis, its
// relative way is not checked against the travel limits.
Result<MovePlan> plan_move(const std::vector<AxisMove>& moves, bool relative, const Positions& from,
                           const Envelope& envelope);

struct SegmentPlan {
  MovePlan move;
  std::array<std::int64_t, kAxisCount> end{};  // where each axis stands after it
  Duration shortest{};                         // by its speeds; it cannot be over sooner
  Duration longest{};                          // it should be over by then, settling aside
};

struct PathPlan {
  AxisSet axes;
  std::array<std::int64_t, kAxisCount> begin{};  // where each axis stands before it
  std::vector<SegmentPlan> segments;

  Register reg() const;  // the prebuffer that its segments are put into
};

// As plan_move, and: the same axes in every segment, straight lines relative and of axes of one scale, no segment
// without any way. Every axis of the path must be known in `from`.
Result<PathPlan> plan_path(const PathRequest& request, const Positions& from, const Envelope& envelope);

}  // namespace axisgate::shrc203
