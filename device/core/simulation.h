// A simulated device, and the words that choose how it behaves.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/time.h"

namespace axisgate {

// Words by key: settings of a kind of device, or options of a simulation.
using Words = std::map<std::string, std::string, std::less<>>;

// A device that exists in this process only.
class Simulation : public LineMachine {
 public:
  // Performs an action of a person at the device. Returns what the person sees, as text. Fails with invalid_request.
  virtual Result<std::string> operate(std::string_view command, TimePoint now) = 0;
};

}  // namespace axisgate
