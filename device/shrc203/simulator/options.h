// Interpretations of the manual where it is silent (device/shrc203/README.md lists them with the manual's sections),
// each with its default first, and the device's settings at power-on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "device/core/named_options.h"

namespace axisgate::shrc203::simulator {

// Returns every option that can be drawn or set by name.
std::span<const OptionName> option_names();

struct AxisSetup {
  std::int64_t nm_per_pulse_e6 = 10'000'000;  // millionths of a nm; default 10 nm per pulse
  // Positions of the limit sensors and of the mechanical origin, relative to the position at power-on.
  std::int64_t travel_minus_pulses = -2'000'000;
  std::int64_t travel_plus_pulses = 2'000'000;
  std::int64_t origin_pulses = -100'000;
  std::int64_t minimum_speed = 1000;   // S, pulses/s
  std::int64_t maximum_speed = 50000;  // F, pulses/s
  int acceleration_ms = 100;           // R
  // S, F and R of the origin return (manual 94) B:).
  std::int64_t origin_minimum_speed = 5000;
  std::int64_t origin_maximum_speed = 500000;
  int origin_acceleration_ms = 100;
};

class Options : public NamedOptions {
 public:
  Options();

  // Controllable axes, as the digit of ?:AXIS (manual 44)): 6 is 1+2+3.
  int axis_setting = 6;
  std::string serial_number = "2106001001";
  std::string firmware = "V2.00.000";
  std::array<AxisSetup, 3> axes;
};

}  // namespace axisgate::shrc203::simulator
