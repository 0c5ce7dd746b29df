// Settings as plain values, as lines of the controller; and its answers as settings.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/stage.h"
#include "device/stage/settings.h"

namespace axisgate::shrc203 {

// In the order in which they are sent; none, where nothing is to change. out_of_range, not_representable.
Result<std::vector<std::string>> lines_for(const Setting& setting, const State& state);

// The questions for Settings, each asked by itself: one without an answer at the time does not prevent the others.
std::span<const std::string_view> setting_questions();

// An answer to one of them. What is none of its kind changes nothing.
void read_setting(std::string_view question, std::string_view answer, AxisSet controllable, Settings& settings);

}  // namespace axisgate::shrc203
