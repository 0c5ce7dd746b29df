// Lookup of a time in the part of a device's recording that the daemon still has.
#pragma once

#include <google/protobuf/timestamp.pb.h>

#include <chrono>
#include <optional>
#include <string>

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Returns the distance of `time` from the start of the recording, rounded down to a second. nullopt if the daemon no
// longer has that part, or does not answer.
std::optional<std::chrono::seconds> place_in_recording(const Session& session, const std::string& device,
                                                       const google::protobuf::Timestamp& time);

}  // namespace axisgate::axisctl
