// Control of the simulated mill by a person, as lines of text. `help` lists all commands.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/rml1/simulator/simulator.h"

namespace axisgate::rml1::simulator {

// Carries out one command, given without its end of line, at `now` in the mill's time. Returns the values that answer
// it, often none. A refused command changes nothing.
Result<std::string> control(Simulator& mill, std::string_view line, TimePoint now);

}  // namespace axisgate::rml1::simulator
