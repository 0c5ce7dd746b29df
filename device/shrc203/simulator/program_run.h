// Events that occur without a command: those of the axes, and the lines of a program between them (manual 105) to 110),
// 114)).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/core/time.h"
#include "device/shrc203/simulator/rig.h"

namespace axisgate::shrc203::simulator {

// Returns the notices that became due on the line since the last call, in order: COMP and TRIG.
std::vector<std::string> take_notices(Rig& rig);

std::optional<TimePoint> next_due(const Rig& rig);

// Processes every event up to `now`, in order and each at its own time.
void run_until(Rig& rig, TimePoint now);

bool in_program_mode(const Rig& rig);  // includes its edit mode

// Starts at line 1. With one_line, the program pauses after the first line (manual 106)).
void start_program(Rig& rig, bool one_line);
void pause_program(Rig& rig);
void resume_program(Rig& rig, bool one_line);
void stop_program(Rig& rig);  // manual 107)

}  // namespace axisgate::shrc203::simulator
