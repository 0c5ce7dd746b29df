#include "clients/cpp/src/requests.h"

#include <fmt/format.h>

#include "clients/cpp/src/amounts.h"

namespace axisgate::client {

v1::MoveRequest move_request(const std::string& device, const Targets& targets, bool relative,
                             const MoveOptions& options) {
  if (targets.empty()) throw InvalidArgument("a move needs at least one axis");
  v1::MoveRequest request;
  request.set_device(device);
  request.set_relative(relative);
  for (const auto& [axis, distance] : targets) {
    v1::AxisTarget& target = *request.add_targets();
    target.set_axis(axis);
    *target.mutable_distance() = to_message(distance);
    if (options.speed) *target.mutable_profile()->mutable_maximum() = to_message(*options.speed);
    if (options.approach) *target.mutable_approach() = to_message(*options.approach);
  }
  return request;
}

void check_point(const std::vector<std::string>& axes, const Point& point) {
  if (!axes.empty() && point.size() == axes.size()) return;
  throw InvalidArgument(fmt::format("a point has {} distances for {} axes", point.size(), axes.size()));
}

v1::Segment segment(const std::vector<std::string>& axes, const Point& point, const std::optional<Speed>& speed) {
  check_point(axes, point);
  v1::Segment message;
  const auto fill = [&](v1::AxisDistance& distance, std::size_t i) {
    distance.set_axis(axes[i]);
    *distance.mutable_distance() = to_message(point[i]);
  };
  if (axes.size() == 1) {
    fill(*message.mutable_single(), 0);
  } else {
    for (std::size_t i = 0; i < axes.size(); ++i) fill(*message.mutable_line()->add_distances(), i);
  }
  if (speed) *message.mutable_speed() = to_message(*speed);
  return message;
}

v1::ScanRequest scan_request(const std::string& device, const ScanTerms& terms) {
  v1::ScanRequest request;
  request.set_device(device);
  request.set_axis(terms.axis);
  *request.mutable_start() = to_message(terms.start);
  *request.mutable_end() = to_message(terms.end);
  *request.mutable_distance() = to_message(terms.every);
  if (terms.speed) *request.mutable_speed() = to_message(*terms.speed);
  return request;
}

v1::AxisJog axis_jog(const std::string& axis, const Speed& speed) {
  const bool minus = speed.each_second().is_negative();
  v1::AxisJog jog;
  jog.set_axis(axis);
  jog.set_direction(minus ? v1::AxisJog::DIRECTION_MINUS : v1::AxisJog::DIRECTION_PLUS);
  *jog.mutable_speed() = to_message(minus ? -speed : speed);
  return jog;
}

}  // namespace axisgate::client
