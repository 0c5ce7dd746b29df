// Functions shared by the verbs that show or change settings.
#pragma once

#include <chrono>

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Deadline of calls for settings. It is long because `wake` moves the stage, and a restarting controller does not
// reply.
inline constexpr std::chrono::seconds kSettingLimit{30};

// Requests all settings from the daemon. Throws Failure.
v1::Settings settings_of(const Session& session, const v1::Device& device);

// Changes the settings that `wanted` has, and prints the result with report_done(). Returns the exit code. Throws
// Failure.
int change_settings(const Session& session, const v1::Device& device, const v1::Settings& wanted);

// Prints "OK", or with --json the response. Returns the exit code.
int report_done(const Session& session, const google::protobuf::Message& response);

// Returns the axes that were named, or all controllable axes if none was.
std::vector<int> chosen_axes(const Session& session, const v1::Device& device);

}  // namespace axisgate::axisctl
