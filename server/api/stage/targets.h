// Axes, targets and speeds as callers give them, completed from what is known of the device.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"

namespace axisgate::api {

// S, F and R of an axis. What is left out stays as the axis has it.
struct Speeds {
  std::optional<Quantity> minimum{}, maximum{};  // per second
  std::optional<int> acceleration_ms{};
};

struct AxisTarget {
  int axis = 0;       // 1 to 3
  Quantity distance;  // a place, or a way where the move is relative
  std::optional<Speeds> speeds{};
  std::optional<Quantity> approach{};
};

struct Move {
  std::vector<AxisTarget> targets;
  bool relative = false;
};

// 1 to 3. unknown_axis.
Result<int> checked_axis(int number);
// Likewise, each once: invalid_request. No axes stay no axes.
Result<stage::AxisSet> checked_axes(const std::vector<int>& numbers);

// "axis 1: ..."
Problem on_axis(int axis, Problem problem);

// The axes meant: all controllable ones where none is named. unknown_axis where one is not controllable; link_down
// where it is not known which are.
Result<stage::AxisSet> controllable_axes(stage::AxisSet named, const stage::State& state);

// invalid_request where something is left out that is not known of the axis.
Result<stage::SpeedProfile> completed(const Speeds& speeds, const stage::AxisState& axis);

// With the device's present speeds. invalid_request.
Result<stage::MoveRequest> completed(const Move& move, const stage::State& state, stage::RequestContext context);

}  // namespace axisgate::api
