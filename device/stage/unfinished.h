// What a run of the gateway that was killed had started.
#pragma once

#include <string>
#include <vector>

#include "device/stage/axes.h"

namespace axisgate::stage {

struct Unfinished {
  std::string serial_number;            // of the controller
  AxisSet moving;                       // that moved, or whose start had been written
  AxisSet jogged;                       // of these, by jogs
  std::string motions;                  // for people: "motion 12 (move, asked by unix anna)"
  std::vector<std::string> last_lines;  // that were written, newest first, without their ends; at most two
};

}  // namespace axisgate::stage
