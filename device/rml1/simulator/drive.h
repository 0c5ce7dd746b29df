// The tool in time: what is queued is done in order, and can be paused or ended at any instant.
#pragma once

#include <deque>
#include <optional>

#include "device/core/time.h"
#include "device/rml1/simulator/options.h"
#include "device/rml1/simulator/record.h"
#include "device/rml1/simulator/route.h"
#include "device/rml1/simulator/spindle.h"
#include "device/rml1/simulator/travel.h"

namespace axisgate::rml1::simulator {

// Time never runs backwards from call to call.
class Drive {
 public:
  // All outlive this.
  Drive(const MillSetup& setup, SpindleMotor& spindle, Record& record);

  // To the end of the queue; run() begins it.
  void move(const Position& to, double mm_per_s);
  void turn(double degrees, double degrees_per_s);
  void dwell(Duration time);
  void start_spindle();  // if it is permitted and stopped; what follows waits for its spin-up
  void stop_spindle();

  // Does what is due by now.
  void run(TimePoint now);
  std::optional<TimePoint> next() const;
  bool idle() const;  // nothing to do, and not paused

  // Ends what is under way, where the tool is now, and forgets the rest; a pause is over.
  void end(TimePoint now);
  // Stops where it is, stops the spindle, and raises the tool if so set (option pause_position).
  void pause(TimePoint now);
  // The spindle starts again if it has rotated, the tool returns, and the rest is done.
  void resume(TimePoint now);
  bool paused() const { return pause_.has_value(); }

  Position tool(TimePoint now) const;
  // When all that is queued has been done; degrees of the axis of rotation.
  Position planned() const { return planned_; }
  double planned_angle() const { return planned_angle_; }

 private:
  struct Work {
    enum class Kind { move, turn, dwell, spin_up, stop_spindle };
    Kind kind = Kind::move;
    Position to{};
    double mm_per_s = 0;
    double degrees = 0;
    Duration time{};
  };
  struct Running {
    Work work;
    bool interlude = false;
    Position from;
    TimePoint began;
    Travel travel;
    Duration time;
  };
  struct Pause {
    Position tool;
    bool spindle = false;
  };

  bool begin_next(TimePoint now);
  void begin(const Work& work, bool interlude, TimePoint now);
  Duration time_of(const Work& work, const Travel& travel);
  Work vertical(const Position& to) const;
  void finish(const Running& done);
  void interrupt(TimePoint now);
  void turned(double degrees);
  Travel travel_to(const Work& work) const;
  double slower() const;

  const MillSetup& setup_;
  SpindleMotor& spindle_;
  Record& record_;
  Position tool_, planned_;
  double angle_ = 0, planned_angle_ = 0;
  std::deque<Work> interlude_;  // of a pause or the return from it, before the queue
  std::deque<Work> queue_;
  std::optional<Running> running_;
  std::optional<Pause> pause_;
  std::optional<Pause> returning_;  // to where a pause began
};

}  // namespace axisgate::rml1::simulator
