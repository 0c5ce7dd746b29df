// Converts settings to the controller's lines, and its answers to settings.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/stage.h"
#include "device/stage/settings.h"

namespace axisgate::shrc203 {

// Returns the lines in the order in which they are sent; empty if nothing has to change. Fails with out_of_range or
// not_representable.
Result<std::vector<std::string>> lines_for(const Setting& setting, const State& state);

// Questions for Settings, each sent alone: a question without an answer does not prevent the others.
std::span<const std::string_view> setting_questions();

// Adds the answer to one of these questions to `settings`. An answer of another form changes nothing.
void read_setting(std::string_view question, std::string_view answer, AxisSet controllable, Settings& settings);

}  // namespace axisgate::shrc203
