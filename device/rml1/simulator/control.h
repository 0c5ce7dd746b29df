// What a person at the simulated mill does and sees, as lines of text: `help` lists them all.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/rml1/simulator/simulator.h"

namespace axisgate::rml1::simulator {

// Carries out one command, without its end of line, at `now` in the mill's time: the values that it answers, often
// none. What is refused has changed nothing.
Result<std::string> control(Simulator& mill, std::string_view line, TimePoint now);

}  // namespace axisgate::rml1::simulator
