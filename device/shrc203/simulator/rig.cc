#include "device/shrc203/simulator/rig.h"

#include <algorithm>
#include <utility>

#include "device/shrc203/simulator/commands/memory_switch_commands.h"

namespace axisgate::shrc203::simulator {

Rig::Rig(Options chosen)
    : options(std::move(chosen)),
      memory(options),
      axes{Axis(options.axes[0]), Axis(options.axes[1]), Axis(options.axes[2])},
      motions(options, axes),
      serial_number(options.serial_number) {
  power_on();
}

bool Rig::is_free(const Axes& named) const {
  return !motions.busy(options.is("busy_scope", "controller") ? controllable : named);
}

bool Rig::is_excited(const Axes& named) const {
  const auto list = named.list();
  return std::all_of(list.begin(), list.end(), [this](int number) { return axis(number).excited; });
}

bool Rig::can_move(const Axes& named) const {
  const auto list = named.list();
  return !sleeping && is_excited(named) &&
         std::none_of(list.begin(), list.end(), [this](int number) { return axis(number).error_stop(); });
}

std::optional<std::int64_t> Rig::to_pulses(Number number, char unit, int axis_number) const {
  const Fraction fraction = options.is("fraction_of_pulse", "truncate") ? Fraction::truncate
                            : options.is("fraction_of_pulse", "ng")     ? Fraction::refuse
                                                                        : Fraction::round;
  return simulator::to_pulses(number, unit, axis(axis_number).pitch(), fraction);
}

void Rig::power_on() {
  triggers.disarm(now);
  saved.places = {};
  motions.power_on();
  program.power_on();
  for (Axis& each : axes) each.power_on(now);
  mode = "HOST";
  hit_format = sleeping = command_error = false;
  lights = beep = true;
  outputs = 0;
  previous_line.clear();
  apply_memory_switches(*this);
}

}  // namespace axisgate::shrc203::simulator
