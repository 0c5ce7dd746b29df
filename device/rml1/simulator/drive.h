// A Drive moves the tool in time: it does the queued work in order, and can be paused or ended at any instant.
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

// Time must never decrease from call to call.
class Drive {
 public:
  // The referenced objects must outlive this one.
  Drive(const MillSetup& setup, SpindleMotor& spindle, Record& record);

  // Each adds work to the end of the queue; run() begins it.
  void move(const Position& to, double mm_per_s);
  void turn(double degrees, double degrees_per_s);
  void dwell(Duration time);
  void start_spindle();  // starts only if permitted and stopped; later work waits for its spin-up
  void stop_spindle();

  // Does the work that is due by now.
  void run(TimePoint now);
  std::optional<TimePoint> next() const;
  bool idle() const;  // nothing to do, and not paused

  // Ends the work in progress with the tool at its present place, and discards the queue and any pause.
  void end(TimePoint now);
  // Stops the tool at its present place, stops the spindle, and raises the tool if so set (option pause_position).
  void pause(TimePoint now);
  // Starts the spindle again if it was rotating, returns the tool, and continues.
  void resume(TimePoint now);
  bool paused() const { return pause_.has_value(); }

  Position tool(TimePoint now) const;
  // Place after all queued work, and angle of the axis of rotation in degrees.
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
  std::deque<Work> interlude_;  // movements of a pause or of the return from it, before the queue
  std::deque<Work> queue_;
  std::optional<Running> running_;
  std::optional<Pause> pause_;
  std::optional<Pause> returning_;  // return to the place where a pause began
};

}  // namespace axisgate::rml1::simulator
