// A SHRC-203 without its hardware. It has its own parser, so that a mistake in the command table does not go unnoticed.
// Written from the manual; `Options` chooses an interpretation where the manual is silent.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/core/simulation.h"
#include "device/shrc203/simulator/boot.h"
#include "device/shrc203/simulator/faults.h"
#include "device/shrc203/simulator/options.h"

namespace axisgate::shrc203::simulator {

// The simulated device. Bytes go in by receive(); it answers through the ByteLink. Time advances only by the given
// `now`; events due before that happen in order, each at its own time. Not thread safe.
class Simulator : public Simulation {
 public:
  Simulator(Options options, ByteLink& line);
  ~Simulator() override;

  // A host opened or closed the line. The device does not notice; an unfinished input line is discarded.
  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;
  // Carries out a line of the control language, without its end, at `now` in the device's time. Returns the values that
  // the command reports, often none. A refused command changes nothing. Defined in control.cc.
  Result<std::string> operate(std::string_view line, TimePoint now) override;

  // Actions and observations of a person at the device.
  std::int64_t position(int axis) const;       // pulses, at the time of the last call
  std::int64_t maximum_speed(int axis) const;  // F, pulses/s, as last set by D: or a prebuffer setting
  bool busy(int axis) const;
  int outputs() const;          // OUT1..OUT6, 0..63
  std::string trigger() const;  // as ?:T reports
  void set_excitation(int axis, bool on, TimePoint now);
  void press_emergency(TimePoint now);
  void set_mode(std::string_view mode, TimePoint now);      // "HOST", "MANUAL", ...; motion continues
  void set_format(std::string_view format, TimePoint now);  // "SHOT_FC" or "HIT"; in HIT only !: and Q: report anything
  bool set_sleep(bool asleep, TimePoint now);               // false: an axis is busy, and nothing was changed
  void set_inputs(int pattern);                             // IN1..IN6, 0..63
  void power_cycle(TimePoint now);                          // as RESET: does; the stages stay where they are
  void set_boot(Boot boot);                                 // for every later reboot
  void set_limit(int axis, int direction, bool on, TimePoint now);  // a limit sensor; direction +1 is CW
  // Raises or ends an error. Raising it stops the axis. BEC: and a reboot also end an overflow error; the others end
  // only by on = false.
  void set_error(int axis, AxisError error, bool on, TimePoint now);
  void set_flag(int axis, AxisFlag flag, bool on, TimePoint now);  // a software limit stops the axis once

  // Faults of the electronics. Slow: each line is carried out and answered `delay` after it arrived, or after the
  // previous line was due. Stuck: for `time`, lines are read and nothing is written; then all of it is sent, in order.
  void set_answer_delay(Duration delay, TimePoint now);
  void be_stuck(Duration time, TimePoint now);
  // Unplugs the cable: for `time`, all bytes in both directions are lost. The device continues and does not notice.
  void be_unplugged(Duration time, TimePoint now);
  // Puts another unit in its place: changes the answers to *IDN? and ?:SN only. For fresh settings, call power_cycle().
  void set_serial_number(std::string number);

  // For tests: number of times an axis was started since construction (each segment of a chain counts), and the
  // received lines, oldest first, at least the last 100,000.
  int starts(int axis) const;
  std::int64_t trigger_pulses() const;  // of the trigger output (manual 97) to 101)) since construction
  const std::vector<std::string>& received() const;
  bool answering() const;  // while it writes: the bytes answer a line (and are not a completion)

 private:
  class Device;
  std::unique_ptr<Device> device_;
};

}  // namespace axisgate::shrc203::simulator
