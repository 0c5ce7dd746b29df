#include "device/shrc203/simulator/simulator.h"

#include <utility>

#include "device/shrc203/simulator/machine.h"
#include "device/shrc203/simulator/program_run.h"

namespace axisgate::shrc203::simulator {

class Simulator::Device : public Machine {
 public:
  using Machine::Machine;

  // Reports the immediate effects of a change that did not come through the line.
  void settle_consequences() {
    run_until(rig(), rig().now);
    send_completions();
  }
};

Simulator::Simulator(Options options, ByteLink& line) : device_(std::make_unique<Device>(std::move(options), line)) {}

Simulator::~Simulator() = default;

void Simulator::link_up(TimePoint now) {
  device_->advance(now);
  device_->forget_unfinished_line();
}

void Simulator::link_down(TimePoint now, std::string_view) {
  device_->advance(now);
  device_->forget_unfinished_line();
}

void Simulator::receive(std::string_view bytes, TimePoint now) { device_->receive(bytes, now); }
void Simulator::advance(TimePoint now) { device_->advance(now); }
std::optional<TimePoint> Simulator::next_deadline() const { return device_->next_event(); }

std::int64_t Simulator::position(int axis) const { return device_->rig().axis(axis).coordinate(device_->rig().now); }

std::int64_t Simulator::maximum_speed(int axis) const { return device_->rig().axis(axis).speed.maximum; }

int Simulator::outputs() const { return device_->rig().outputs; }

std::string Simulator::trigger() const { return device_->rig().triggers.describe(); }

bool Simulator::busy(int axis) const { return device_->rig().motions.busy(axis); }

void Simulator::set_excitation(int axis, bool on, TimePoint now) {
  device_->advance(now);
  if (on) {
    device_->rig().axis(axis).excited = true;
  } else {
    device_->rig().motions.lose_excitation(axis, now);
  }
  device_->settle_consequences();
}

void Simulator::press_emergency(TimePoint now) {
  device_->advance(now);
  device_->rig().motions.emergency_stop(now);
}

void Simulator::set_mode(std::string_view mode, TimePoint now) {
  device_->advance(now);
  device_->rig().mode = mode;
}

void Simulator::set_inputs(int pattern) {
  device_->rig().inputs = pattern;
  device_->rig().motions.inputs_are(pattern, device_->rig().now);
  device_->settle_consequences();
}

void Simulator::set_format(std::string_view format, TimePoint now) {
  device_->advance(now);
  device_->rig().hit_format = format == "HIT";
}

bool Simulator::set_sleep(bool asleep, TimePoint now) {
  device_->advance(now);
  if (device_->rig().motions.busy(device_->rig().controllable)) return false;
  device_->rig().sleeping = asleep;
  return true;
}

void Simulator::power_cycle(TimePoint now) { device_->reboot(now); }
void Simulator::set_boot(Boot boot) { device_->set_boot(std::move(boot)); }

void Simulator::set_limit(int axis, int direction, bool on, TimePoint now) {
  device_->advance(now);
  device_->rig().axis(axis).force_limit(direction, on, now);
  device_->settle_consequences();
}

void Simulator::set_error(int axis, AxisError error, bool on, TimePoint now) {
  device_->advance(now);
  device_->rig().axis(axis).errors.set(error, on);
  if (on) device_->rig().motions.error_stop(axis, now);
  device_->settle_consequences();
}

void Simulator::set_flag(int axis, AxisFlag flag, bool on, TimePoint now) {
  device_->advance(now);
  device_->rig().axis(axis).flags.set(flag, on);
  const bool stops = flag == AxisFlag::cw_software_limit || flag == AxisFlag::ccw_software_limit;
  if (on && stops) device_->rig().motions.error_stop(axis, now);
  device_->settle_consequences();
}

void Simulator::set_answer_delay(Duration delay, TimePoint now) {
  device_->advance(now);
  device_->set_answer_delay(delay);
}

void Simulator::be_stuck(Duration time, TimePoint now) {
  device_->advance(now);
  device_->be_stuck(now + time);
}

void Simulator::be_unplugged(Duration time, TimePoint now) {
  device_->advance(now);
  device_->be_unplugged(now + time);
}

void Simulator::set_serial_number(std::string number) { device_->rig().serial_number = std::move(number); }

std::int64_t Simulator::trigger_pulses() const { return device_->rig().triggers.emitted(device_->rig().now); }
int Simulator::starts(int axis) const { return device_->rig().motions.starts(axis); }
const std::vector<std::string>& Simulator::received() const { return device_->received(); }
bool Simulator::answering() const { return device_->answering(); }

}  // namespace axisgate::shrc203::simulator
