// Conversion of settings from and to callers' messages.
#pragma once

#include "axisgate/v1/settings.pb.h"
#include "device/core/problem.h"
#include "device/stage/settings.h"
#include "server/api/request/axis_names.h"
#include "server/api/stage/setting_lines.h"

namespace axisgate::proto {

// Fails with invalid_request, and for an amount like to_quantity().
Result<api::SettingsChange> to_change(const v1::Settings& settings, const api::AxisNames& names);
Result<api::NewCoordinates> to_coordinates(const v1::SetCoordinatesRequest& request, const api::AxisNames& names);

v1::Settings to_proto(const stage::Settings& settings);

}  // namespace axisgate::proto
