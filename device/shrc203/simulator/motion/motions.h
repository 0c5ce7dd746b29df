// Motions of the axes with their buffers: starts, ends, completions, and the double buffer of manual section 2.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "device/core/time.h"
#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/buffer.h"
#include "device/shrc203/simulator/motion/axis.h"
#include "device/shrc203/simulator/options.h"

namespace axisgate::shrc203::simulator {

class Motions {
 public:
  enum class Accepted { no, waits_for_go, chained };

  // Time from the last pulse to READY, if W: adds nothing.
  static constexpr Duration kSettling = std::chrono::milliseconds(5);

  Motions(const Options& options, std::array<Axis, kAxes>& axes) : options_(options), axes_(axes) {}

  void power_on();

  bool busy(int axis) const;
  bool busy(const Axes& axes) const;
  bool returning(int axis, Kind kind) const;  // for bits 18 and 19 of the status

  void set_execution(Setting setting);
  Accepted set_prebuffer(const Setting& setting);
  void delete_execution(const Axes& axes);  // manual 87) GC:

  // Returns the content of an execution register: set, or being executed.
  const Setting* execution(Kind kind, int axis) const;
  const Setting* execution(Kind kind) const;
  const Buffer& prebuffer() const { return prebuffer_; }

  // Starts what is set (manual 85), 86)). False if nothing of these axes can start.
  bool go(const Axes& axes, TimePoint now);
  void start_each(const Setting& setting, bool reports, TimePoint now);  // at once, each axis independently
  // Starts a setting without using the buffers.
  void start_at_once(const Setting& setting, TimePoint now) { start(setting, now); }
  void start_return(Kind kind, const Axes& axes, bool reports, TimePoint now);

  // JD: (manual 93)). jogging() reports whether J: drives each of these axes and none is being stopped; override_jog()
  // sets the speed from now on, in pulses/s.
  bool jogging(const Axes& axes) const;
  void override_jog(int axis, std::int64_t to_speed, TimePoint now);

  void stop(const Axes& axes, TimePoint now);
  void emergency_stop(TimePoint now);
  void lose_excitation(int axis, TimePoint now);
  void error_stop(int axis, TimePoint now);       // without a further pulse; counts as a stop by L:
  void release(const Axes& axes, TimePoint now);  // ends the wait for READY, for BEC: (manual 53))
  void end_wait(Kind kind, const Axes& axes, TimePoint now);
  void inputs_are(int pattern, TimePoint now);

  // Wait of W:, in tenths of a second.
  int wait_tenths = 0;

  std::optional<TimePoint> next_event() const;
  // Processes every event up to `now`, in order and each at its own time.
  void process(TimePoint now);

  // Returns the axis numbers that became due on the line since the last call, in order.
  std::vector<int> take_completions();
  int starts(int axis) const { return starts_[index_of(axis)]; }

 private:
  struct Run {
    Setting setting;
    bool reports = false;
    Axes unfinished;
    Axes stopped;
  };

  Axis& axis(int number) { return axes_[index_of(number)]; }
  const Axis& axis(int number) const { return axes_[index_of(number)]; }
  bool is(std::string_view option, std::string_view value) const { return options_.is(option, value); }

  Run* run_of(int axis);
  bool operating(int axis) const;
  bool any_operating(const Axes& axes) const;
  bool on_double_buffer(const Axes& axes) const;
  bool stopping(const Axes& axes) const;
  Accepted acceptance(const Axes& axes) const;

  bool can_start(const Axes& axes) const;
  void start(const Setting& setting, TimePoint now);
  void start_axis(const Setting& setting, int axis, TimePoint now);
  void forget_limit(int axis);
  void start_line(const Setting& setting, TimePoint now);
  void start_arc(const Setting& setting, TimePoint now);
  void start_migrated(TimePoint now);
  void migrate();

  void handle_event(int axis, TimePoint now);
  void pulses_ended(int axis, TimePoint now);
  void finish(int axis, TimePoint now);
  void complete(const Run& run, int axis, bool done);
  void leave_jog(const Run& run, int axis);
  void stop_run(Run& run, const Axes& axes, bool slowly, TimePoint now);
  void apply_stop_to_prebuffer(const Axes& axes);

  const Options& options_;
  std::array<Axis, kAxes>& axes_;
  Buffer execution_;
  Buffer prebuffer_;
  Buffer migrated_;  // in the execution buffer; started when their axes are READY
  std::vector<Run> runs_;
  std::vector<int> completions_;
  std::array<int, kAxes> starts_{};
  int inputs_ = 0;
};

}  // namespace axisgate::shrc203::simulator
