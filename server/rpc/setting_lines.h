// Settings as callers write them, as lines of the controller.
#pragma once

#include <string>
#include <vector>

#include "axisgate/v1/settings.pb.h"
#include "device/core/problem.h"
#include "device/stage/stage_controller.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

using Lines = std::vector<std::string>;

// Of what is given, in the order of the manual. unknown_axis, invalid_request, out_of_range, unknown_unit,
// not_representable; link_down where amounts cannot be converted yet.
Result<Lines> lines_of(const api::ChangeSettingsRequest& request, const stage::State& state);
Result<Lines> lines_of(const api::SetCoordinatesRequest& request, const stage::State& state);

// What is asked for Settings, and an answer's place in them.
const std::vector<std::string_view>& setting_questions();
void fill_setting(std::string_view question, const std::string& answer, const stage::State& state,
                  api::Settings& settings);

// Outputs and trigger as last read or set.
void fill_known(const stage::State& state, api::Settings& settings);

}  // namespace axisgate::rpc
