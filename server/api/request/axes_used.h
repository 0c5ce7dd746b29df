// Axes that a request needs the right to.
#pragma once

#include "device/stage/axes.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"

namespace axisgate::api {

// Returns the axes that the controller will require when the request begins. Ignores numbers that are not an axis.
stage::AxisSet axes_used(const stage::MoveRequest& move, const stage::State& state);
stage::AxisSet axes_used(const stage::HomeRequest& home, const stage::State& state);
stage::AxisSet axes_used(const stage::ScanRequest& scan, const stage::State& state);
stage::AxisSet axes_used(const stage::GoToPositionRequest& position, const stage::State& state);
stage::AxisSet axes_used(const stage::JogRequest& jog, const stage::State& state);

// Returns no axes: they are known only when the request begins, as with a caller's own command lines.
template <class Other>
stage::AxisSet axes_used(const Other&, const stage::State&) {
  return {};
}

}  // namespace axisgate::api
