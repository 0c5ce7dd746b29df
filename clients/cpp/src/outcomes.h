// Results of the package from messages of the API.
#pragma once

#include <string>

#include "axisgate/results.h"
#include "axisgate/state.h"
#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/motion.pb.h"
#include "axisgate/v1/stage.pb.h"

namespace axisgate::client {

// Returns the result of a motion with its outcome. Throws Stopped, MotionFailed or OutcomeUnknown for another outcome
// than success.
MotionResult outcome_of(const v1::Motion& motion);

// Returns the progress of a motion; `first` is the device when the motion was first seen.
Progress progress_of(const v1::Motion& motion, const v1::Device& first, const v1::Device& now);

StopReport report_of(const google::protobuf::RepeatedPtrField<v1::DeviceStop>& devices, bool stays_open);

Status status_of(const v1::Device& device);

// Returns "RUNNING" for MOTION_STATE_RUNNING.
std::string state_name(v1::MotionState state);

// Returns the configured name of an axis, or its number as text.
std::string axis_name(const std::string& name, int number);

// Returns "stage" for "devices/stage".
std::string last_part(std::string_view resource);

}  // namespace axisgate::client
