// The whole state that a command can see or change.
#pragma once

#include <array>
#include <string>

#include "device/core/time.h"
#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/memory_switches.h"
#include "device/shrc203/simulator/motion/axis.h"
#include "device/shrc203/simulator/motion/motions.h"
#include "device/shrc203/simulator/motion/triggers.h"
#include "device/shrc203/simulator/options.h"
#include "device/shrc203/simulator/program.h"
#include "device/shrc203/simulator/saved_positions.h"

namespace axisgate::shrc203::simulator {

struct Rig {
  explicit Rig(Options chosen);
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  Axis& axis(int number) { return axes[index_of(number)]; }
  const Axis& axis(int number) const { return axes[index_of(number)]; }

  // Reports whether the named axes, or with busy_scope "controller" all axes, are free ("In the case of Busy").
  bool is_free(const Axes& named) const;
  bool is_excited(const Axes& named) const;
  bool can_move(const Axes& named) const;  // excited, awake, no error except a limit error

  std::optional<std::int64_t> to_pulses(Number number, char unit, int axis_number) const;

  // Resets settings to the values of the memory switches; the stages stay where they are.
  void power_on();

  const Options options;
  MemorySwitches memory;
  int axis_setting = 6;  // manual 44)
  Axes controllable;     // axes of axis_setting
  std::array<Axis, kAxes> axes;
  Motions motions;
  Triggers triggers{axes};
  SavedPositions saved;
  ProgramMode program;
  TimePoint now{};
  std::string serial_number;
  std::string mode;
  bool hit_format = false;
  bool sleeping = false;
  bool lights = true;
  bool beep = true;
  int outputs = 0;
  int inputs = 0;
  bool command_error = false;
  std::string previous_line;
};

}  // namespace axisgate::shrc203::simulator
