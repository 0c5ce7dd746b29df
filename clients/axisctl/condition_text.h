// The conditions of a stage and their times, in words.
#pragma once

#include <google/protobuf/repeated_field.h>

#include <string>

#include "axisgate/v1/device.pb.h"

namespace axisgate::axisctl {

// "axes 1 and 2: emergency stop"; "controller in MANUAL mode", where no axis is named.
std::string condition_text(v1::Condition condition, const google::protobuf::RepeatedField<std::int32_t>& axes,
                           bool begun, const std::string& value);
// "emergency stop, CW limit sensor on"; "normal" of an axis without a condition.
std::string status_text(const v1::Axis& axis);

// The times of two readings between which something changed; of the first reading at all, which found it so.
std::string between_text(const std::string& before, const std::string& seen);
std::string found_text(const std::string& seen);

}  // namespace axisgate::axisctl
