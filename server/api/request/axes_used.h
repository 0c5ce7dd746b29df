// Which axes a request needs the right to.
#pragma once

#include "device/stage/axes.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"

namespace axisgate::api {

// As the controller will demand it when the request begins. Numbers that are no axis are left out.
stage::AxisSet axes_used(const stage::MoveRequest& move, const stage::State& state);
stage::AxisSet axes_used(const stage::HomeRequest& home, const stage::State& state);
stage::AxisSet axes_used(const stage::ScanRequest& scan, const stage::State& state);
stage::AxisSet axes_used(const stage::GoToPositionRequest& position, const stage::State& state);
stage::AxisSet axes_used(const stage::JogRequest& jog, const stage::State& state);

// None: which it needs is known only when it begins, as of a caller's own lines.
template <class Other>
stage::AxisSet axes_used(const Other&, const stage::State&) {
  return {};
}

}  // namespace axisgate::api
