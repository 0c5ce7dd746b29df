// A motion or job that occupies a device, for people.
#pragma once

#include <optional>
#include <string>

#include "device/core/time.h"

namespace axisgate::use {

// An Occupation describes a motion or a job to the callers who wait for its scope.
struct Occupation {
  std::string by;                // "move by unix bert"
  std::string before, after;     // text around the parentheses: "axis 1 is in motion 1312", ""
  std::optional<TimePoint> due;  // expected end; nullopt if unknown
};
// "axis 1 is in motion 1312 (move by unix bert, 4 s left)".
std::string text_of(const Occupation& occupation, TimePoint now);

}  // namespace axisgate::use
