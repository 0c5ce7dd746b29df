// Settings as callers write and read them.
#pragma once

#include <string>
#include <vector>

#include "axisgate/v1/settings.pb.h"
#include "device/core/problem.h"
#include "device/stage/kind.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

using Lines = std::vector<std::string>;

// The lines of what is given, in the order of the manual. unknown_axis, invalid_request, out_of_range, unknown_unit,
// not_representable; link_down where amounts cannot be converted yet.
Result<Lines> lines_of(const api::ChangeSettingsRequest& request, const stage::Kind& kind, const stage::State& state);
Result<Lines> lines_of(const api::SetCoordinatesRequest& request, const stage::Kind& kind, const stage::State& state);

// Outputs and trigger as last read or set.
stage::Settings known_settings(const stage::State& state);

api::Settings to_proto(const stage::Settings& settings);

}  // namespace axisgate::rpc
