// The state of the device after a reboot.
#pragma once

#include <string>

#include "device/core/time.h"

namespace axisgate::shrc203::simulator {

// State after a reboot (manual 46) RESET:, or the power switch), which a real controller takes from its memory
// switches.
struct Boot {
  std::string mode = "HOST";                   // as ?:MODE answers (manual 37)); HOST: set by MODE SEL
  std::string format = "SHOT_FC";              // as ?:FMT answers (manual 38)), or HIT; SHOT_FC: set by CMD FORMAT
  Duration silence = std::chrono::seconds(1);  // time in which nothing is read or answered
};

}  // namespace axisgate::shrc203::simulator
