// Configuration of one SHRC-203, checked before the daemon starts.
#pragma once

#include "device/shot/profile.h"

namespace axisgate::shrc203 {

// Extent to which one axis concerns the others, in cases that the manual leaves open (device/shrc203/README.md).
enum class Scope { axis, controller };

struct Profile : shot::Profile {
  Scope busy_scope = Scope::controller;
  Scope prebuffer_scope = Scope::controller;
  bool wait_for_inputs = false;  // WI: is accepted, which lets an input pin start a motion
};

}  // namespace axisgate::shrc203
