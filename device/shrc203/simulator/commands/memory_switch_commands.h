// The edit mode of the memory switches, and the effect of the switches at power-on (manual 117) to 126)).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/simulator/rig.h"

namespace axisgate::shrc203::simulator {

inline constexpr std::string_view kMemorySwitchMode = "HOST,MS";  // manual 37)

// Reports whether the line works in this mode, as listed in manual 117).
bool works_in_memory_switch_mode(std::string_view line);

// Reports whether the line is MS:GET, MS:DEFR, MS:GETK or MS:DEFRK.
bool is_memory_switch_question(std::string_view line);
std::optional<std::string> answer_memory_switch(const Rig& rig, std::string_view line);

void apply_memory_switches(Rig& rig);

}  // namespace axisgate::shrc203::simulator
