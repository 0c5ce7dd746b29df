// Axes, targets and speeds as callers give them, completed from the known state of the device.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"
#include "server/devices/device.h"

namespace axisgate::api {

// Speeds are S, F and R of an axis. Members that are left out keep the axis's present value.
struct Speeds {
  std::optional<Quantity> minimum{}, maximum{};  // per second
  std::optional<int> acceleration_ms{};
};

struct AxisTarget {
  int axis = 0;       // from 1
  Quantity distance;  // a position, or a displacement if the move is relative
  std::optional<Speeds> speeds{};
  std::optional<Quantity> approach{};
};

struct Move {
  std::vector<AxisTarget> targets;
  bool relative = false;
};

// A Scan is a scan whose interval is not converted to pulses yet.
struct Scan {
  stage::ScanRequest request;  // without interval and context
  Quantity interval;           // with request.by_scale: in scale pulses
};

// Fails with unknown_axis if `device`, a stage, has fewer axes than named.
Result<void> check_axes(stage::AxisSet named, const server::Device& device);

// Returns the problem with its axis: "axis 1: ...".
Problem on_axis(int axis, Problem problem);

// Returns the named axes, or all controllable axes if none is named. Fails with unknown_axis if an axis is not
// controllable, and with link_down if the controllable axes are unknown.
Result<stage::AxisSet> controllable_axes(stage::AxisSet named, const stage::State& state);

// Fails with invalid_request if a value is left out and the axis's present value is unknown.
Result<stage::SpeedProfile> completed(const Speeds& speeds, const stage::AxisState& axis);

// Converts the interval. Fails with link_down if the resolution of the axis is unknown, and like to_pulses().
Result<stage::ScanRequest> completed(const Scan& scan, const stage::State& state, use::RequestContext context);
// Returns the distance in drive pulses of the axis. Fails like the function above.
Result<std::int64_t> to_drive_pulses(const Quantity& distance, int axis, const stage::State& state);

// Completes the move with the device's present speeds. Fails with invalid_request.
Result<stage::MoveRequest> completed(const Move& move, const stage::State& state, use::RequestContext context);

}  // namespace axisgate::api
