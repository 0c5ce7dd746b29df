#include "server/api/request/axes_used.h"

namespace axisgate::api {
namespace {

using stage::AxisSet;

template <class Items>
AxisSet axes_of(const Items& items) {
  AxisSet axes;
  for (const auto& item : items) {
    if (item.axis >= 1 && item.axis <= stage::kAxesMax) axes.add(item.axis);
  }
  return axes;
}

}  // namespace

AxisSet axes_used(const stage::MoveRequest& move, const stage::State&) { return axes_of(move.moves); }

AxisSet axes_used(const stage::HomeRequest& home, const stage::State& state) {
  return home.axes.empty() ? state.controllable() : home.axes;
}

// There is one trigger for all axes.
AxisSet axes_used(const stage::ScanRequest&, const stage::State& state) { return state.controllable(); }

// A saved position has a coordinate of every axis.
AxisSet axes_used(const stage::GoToPositionRequest&, const stage::State& state) { return state.controllable(); }

AxisSet axes_used(const stage::JogRequest& jog, const stage::State&) { return axes_of(jog.axes); }

}  // namespace axisgate::api
