// Configuration of one SHRC-203, checked before the daemon starts.
#pragma once

#include <cstdint>

#include "device/shot/profile.h"

namespace axisgate::shrc203 {

// Extent to which one axis concerns the others, in cases that the manual leaves open (device/shrc203/README.md).
enum class Scope { axis, controller };

inline constexpr std::int64_t kSpeedMax = 1'000'000;  // pulses/s (manual 89) D:)

struct Profile : shot::Profile {
  Profile() : Profile(stage::Profile()) {}
  explicit Profile(const stage::Profile& common) : shot::Profile{common} { speed_max = kSpeedMax; }

  Scope busy_scope = Scope::controller;
  Scope prebuffer_scope = Scope::controller;
  bool wait_for_inputs = false;  // WI: is accepted, which lets an input pin start a motion
};

}  // namespace axisgate::shrc203
