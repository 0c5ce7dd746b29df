// What all verbs around settings share: asking for them, and changing them.
#pragma once

#include <chrono>

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Waking up moves a stage, and a controller that restarts is silent meanwhile.
inline constexpr std::chrono::seconds kSettingLimit{30};

// All settings, as requested from the daemon now. Throws Failure.
v1::Settings settings_of(const Session& session, const v1::Device& device);

// Changes what is given; prints and exits as every verb that does. Throws Failure.
int change_settings(const Session& session, const v1::Device& device, const v1::Settings& wanted);

// "OK", or the answer.
int report_done(const Session& session, const google::protobuf::Message& response);

// The axes that were named; none: all that can be moved.
std::vector<int> chosen_axes(const Session& session, const v1::Device& device);

}  // namespace axisgate::axisctl
