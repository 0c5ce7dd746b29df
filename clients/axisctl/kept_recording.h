// What the daemon still has of a device's recording.
#pragma once

#include <google/protobuf/timestamp.pb.h>

#include <chrono>
#include <optional>
#include <string>

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// How long after the beginning of the recording a time is, to a second; nothing: that part is no longer kept, or the
// daemon does not answer.
std::optional<std::chrono::seconds> place_in_recording(const Session& session, const std::string& device,
                                                       const google::protobuf::Timestamp& time);

}  // namespace axisgate::axisctl
