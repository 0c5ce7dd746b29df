// A SHRC-203 without its hardware: parses with its own code, so that a mistake in the command table cannot agree with
// itself. Written from the manual; where the manual is silent, `Options` chooses the reading.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/shrc203/simulator/boot.h"
#include "device/shrc203/simulator/faults.h"
#include "device/shrc203/simulator/options.h"

namespace axisgate::shrc203::simulator {

// The simulated device. Bytes go in by receive(); it answers through the ByteLink. Time runs only by the `now` given;
// events that became due before it happen in their order, each at its own time. Not thread safe.
class Simulator : public LineMachine {
 public:
  Simulator(Options options, ByteLink& line);
  ~Simulator() override;

  // A host opened or closed the line. The device does not notice; an unfinished input line is forgotten.
  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

  // What a person standing at the device could do or see.
  std::int64_t position(int axis) const;       // pulses, at the time of the last call
  std::int64_t maximum_speed(int axis) const;  // F, pulses/s, as D: or a prebuffer setting has left it
  bool busy(int axis) const;
  int outputs() const;          // OUT1..OUT6, 0..63
  std::string trigger() const;  // as ?:T reports
  void set_excitation(int axis, bool on, TimePoint now);
  void press_emergency(TimePoint now);
  void set_mode(std::string_view mode, TimePoint now);      // "HOST", "MANUAL", ...; what moves continues
  void set_format(std::string_view format, TimePoint now);  // "SHOT_FC" or "HIT"; in HIT only !: and Q: tell anything
  bool set_sleep(bool asleep, TimePoint now);               // false: something moves, and nothing was changed
  void set_inputs(int pattern);                             // IN1..IN6, 0..63
  void power_cycle(TimePoint now);                          // as RESET: does; the stages stay where they are
  void set_boot(Boot boot);                                 // of every reboot from now on
  void set_limit(int axis, int direction, bool on, TimePoint now);  // a limit sensor; direction +1 is CW
  // Stops the axis. An overflow error ends by BEC: or a reboot too, the others only by on = false.
  void set_error(int axis, AxisError error, bool on, TimePoint now);
  void set_flag(int axis, AxisFlag flag, bool on, TimePoint now);  // a software limit's stops the axis, once

  // Faults of its electronics. Slow: a line is carried out and answered `delay` after it came, or after its predecessor
  // was. Stuck: for `time`, lines are read and nothing is written; then all of it comes, in order.
  void set_answer_delay(Duration delay, TimePoint now);
  void be_stuck(Duration time, TimePoint now);
  // The cable: for `time`, what is sent either way is lost. The device continues, and notices nothing.
  void be_unplugged(Duration time, TimePoint now);
  // Another unit stands in its place: what *IDN? and ?:SN say. Its settings are another matter: power_cycle().
  void set_serial_number(std::string number);

  // For tests: how often an axis was set in motion since construction (each segment of a chain counts), and the lines
  // received, oldest first: the last 100,000 at least.
  int starts(int axis) const;
  std::int64_t trigger_pulses() const;  // on the trigger output (manual 97) to 101)) since construction
  const std::vector<std::string>& received() const;
  bool answering() const;  // while it writes: whether this answers a line (and is no completion)

 private:
  class Device;
  std::unique_ptr<Device> device_;
};

}  // namespace axisgate::shrc203::simulator
