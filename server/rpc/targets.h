// Moves, path segments and scans as callers write them, as a controller takes them.
#pragma once

#include "axisgate/v1/stage.pb.h"
#include "device/core/problem.h"
#include "device/stage/stage_controller.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

// What a profile leaves open is taken from the axis's present S, F and R in `state`.
Result<stage::MoveRequest> to_move(const api::MoveRequest& request, const stage::State& state,
                                   stage::RequestContext context);

// Likewise. invalid_request where something is left open that is not known of the axis.
Result<stage::SpeedProfile> to_profile(const api::Profile& profile, const stage::AxisState& axis);

Result<stage::Segment> to_segment(const api::Segment& segment);

// Ends, speed and interval are the controller's to judge.
Result<stage::ScanRequest> to_scan(const api::ScanRequest& request, stage::RequestContext context);

// "axis 1: ..."
Problem on_axis(int axis, Problem problem);

// The axes meant: all controllable ones where none is named; unknown_axis where one is not controllable; link_down
// where it is not known which are.
Result<stage::AxisSet> controllable_axes(stage::AxisSet named, const stage::State& state);

}  // namespace axisgate::rpc
