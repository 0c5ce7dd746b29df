// Request messages.
#pragma once

#include "axisgate/stage.h"
#include "axisgate/v1/stage.pb.h"

namespace axisgate::client {

// All throw InvalidArgument if an amount or the number of axes is wrong.
v1::MoveRequest move_request(const std::string& device, const Targets& targets, bool relative,
                             const MoveOptions& options);
// Returns the piece of a path that leads to a point.
v1::Segment segment(const std::vector<std::string>& axes, const Point& point, const std::optional<Speed>& speed);
v1::ScanRequest scan_request(const std::string& device, const ScanTerms& terms);
v1::AxisJog axis_jog(const std::string& axis, const Speed& speed);

// Throws InvalidArgument unless there is one distance for each axis.
void check_point(const std::vector<std::string>& axes, const Point& point);

}  // namespace axisgate::client
