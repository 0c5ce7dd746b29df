// State that one run of the gateway leaves to the next: motions that were running when it was killed, stops that were
// not confirmed, and the latch of an emergency stop.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/stage/axes.h"
#include "device/stage/stop.h"

namespace axisgate::stage {

struct Unfinished {
  std::string serial_number;  // serial number of the controller
  AxisSet moving;             // axes that moved, or whose start had been written
  AxisSet jogged;             // axes of `moving` that a jog moved
  std::string motions;        // text for people: "motion 12 (move, asked by unix anna)"
  // Lines that the controller may have received last, without their line ends: the newest answered line, and all
  // different lines since then.
  std::vector<std::string> last_lines;
};

struct Inheritance {
  std::optional<Unfinished> unfinished;  // nullopt: no axis moved
  std::vector<Stop> open_stops;
  std::optional<EmergencyLatch> emergency;
  StopId last_stop = 0;
};

// Returns what concerns `axes`. A record may name others: it was damaged, or the device was of another kind.
Inheritance within(AxisSet axes, Inheritance left);

}  // namespace axisgate::stage
