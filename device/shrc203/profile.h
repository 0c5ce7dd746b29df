// The configuration of one SHRC-203, checked before the daemon starts.
#pragma once

#include <string>

#include "device/core/time.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// How far one axis's business concerns the others, where the manual does not say (device/shrc203/README.md).
enum class Scope { axis, controller };

// What the refills of a running path are to its line. `reserved`: they go before everything but a stop, and the line is
// free when they are due. The others only show what that is needed for: no configuration names them.
enum class Refills { reserved, first, among_questions };

struct Profile : stage::Profile {
  std::string model = "SHRC-203";  // what *IDN? must say
  Scope busy_scope = Scope::controller;
  Scope prebuffer_scope = Scope::controller;
  bool wait_for_inputs = false;  // WI: is taken, by which an input pin starts a motion
  Refills refills = Refills::reserved;
};

}  // namespace axisgate::shrc203
