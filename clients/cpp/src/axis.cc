#include <utility>

#include "axisgate/stage.h"

namespace axisgate {

AxisState Axis::state() const { return stage_.status(std::chrono::milliseconds(0)).axis(name_); }

Motion Axis::start(const Distance& target, const MoveOptions& options) const {
  return stage_.start({{name_, target}}, options);
}

Motion Axis::start_by(const Distance& displacement, const MoveOptions& options) const {
  return stage_.start_by({{name_, displacement}}, options);
}

MotionResult Axis::move_to(const Distance& target, const MoveOptions& options) const {
  return stage_.move_to({{name_, target}}, options);
}

MotionResult Axis::move_by(const Distance& displacement, const MoveOptions& options) const {
  return stage_.move_by({{name_, displacement}}, options);
}

MotionResult Axis::home(std::stop_token stop) const { return stage_.home({name_}, std::move(stop)); }

StopReport Axis::stop() const { return stage_.stop({name_}); }

}  // namespace axisgate
