// How the device comes back from a reboot.
#pragma once

#include <string>

#include "device/core/time.h"

namespace axisgate::shrc203::simulator {

// What a reboot (manual 46) RESET:, or the power switch) ends in: the memory switches of a real unit.
struct Boot {
  std::string mode = "HOST";                   // as ?:MODE answers (manual 37)); HOST: as MODE SEL has it
  std::string format = "SHOT_FC";              // as ?:FMT answers (manual 38)), or HIT; SHOT_FC: as CMD FORMAT has it
  Duration silence = std::chrono::seconds(1);  // nothing is read or answered meanwhile
};

}  // namespace axisgate::shrc203::simulator
