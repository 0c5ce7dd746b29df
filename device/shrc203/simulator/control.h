// Commands of a person at the simulated device, as lines of text: `help` lists them all.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/shrc203/simulator/simulator.h"

namespace axisgate::shrc203::simulator {

// Carries out one command, without its end of line, at `now` in the device's time. Returns the values that the command
// reports, often none. A refused command changes nothing.
Result<std::string> control(Simulator& device, std::string_view line, TimePoint now);

}  // namespace axisgate::shrc203::simulator
