// Texts for the conditions of a stage and for their times.
#pragma once

#include <google/protobuf/repeated_field.h>

#include <string>

#include "axisgate/v1/device.pb.h"

namespace axisgate::axisctl {

// Returns "axes 1 and 2: emergency stop", or, for a condition without axes, "controller in MANUAL mode".
std::string condition_text(v1::Condition condition, const google::protobuf::RepeatedField<std::int32_t>& axes,
                           bool begun, const std::string& value);
// Returns "emergency stop, CW limit sensor on", or "normal" if the axis has no condition.
std::string status_text(const v1::Axis& axis);

// Returns when something changed: between two readings, or found_text() if the very first reading already showed it.
std::string between_text(const std::string& before, const std::string& seen);
std::string found_text(const std::string& seen);

}  // namespace axisgate::axisctl
