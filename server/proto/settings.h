// Settings as callers write and read them.
#pragma once

#include "axisgate/v1/settings.pb.h"
#include "device/core/problem.h"
#include "device/stage/settings.h"
#include "server/api/stage/setting_lines.h"

namespace axisgate::proto {

// Of amounts as to_quantity(); invalid_request.
Result<api::SettingsChange> to_change(const v1::Settings& settings);
Result<api::NewCoordinates> to_coordinates(const v1::SetCoordinatesRequest& request);

v1::Settings to_proto(const stage::Settings& settings);

}  // namespace axisgate::proto
