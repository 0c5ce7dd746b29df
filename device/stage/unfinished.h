// What a run of the gateway leaves to the next one: motions that it had started when it was killed, stops that were not
// seen to be obeyed, and the latch of an emergency stop.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/stage/axes.h"
#include "device/stage/stop.h"

namespace axisgate::stage {

struct Unfinished {
  std::string serial_number;  // of the controller
  AxisSet moving;             // that moved, or whose start had been written
  AxisSet jogged;             // of these, by jogs
  std::string motions;        // for people: "motion 12 (move, asked by unix anna)"
  // The lines that the controller may have received last, without their ends: the newest that was answered, and all
  // different ones since.
  std::vector<std::string> last_lines;
};

struct Inheritance {
  std::optional<Unfinished> unfinished;  // nullopt: nothing moved
  std::vector<Stop> open_stops;
  std::optional<EmergencyLatch> emergency;
  StopId last_stop = 0;
};

}  // namespace axisgate::stage
