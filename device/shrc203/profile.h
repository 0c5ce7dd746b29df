// Configuration of one SHRC-203, checked before the daemon starts.
#pragma once

#include <string>

#include "device/core/time.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// Extent to which one axis concerns the others, in cases that the manual leaves open (device/shrc203/README.md).
enum class Scope { axis, controller };

// Priority of a running path's refills on its line. `reserved`: they go before everything but stops, and the line is
// kept free when they are due. The others only show why this is needed: no configuration names them.
enum class Refills { reserved, first, among_questions };

struct Profile : stage::Profile {
  std::string model = "SHRC-203";  // model that *IDN? must report
  Scope busy_scope = Scope::controller;
  Scope prebuffer_scope = Scope::controller;
  bool wait_for_inputs = false;  // WI: is accepted, which lets an input pin start a motion
  Refills refills = Refills::reserved;
};

}  // namespace axisgate::shrc203
