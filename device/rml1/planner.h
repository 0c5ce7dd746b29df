// How long a job takes: straight moves with trapezoids, and corners that are not taken at full speed.
#pragma once

#include <cstddef>
#include <deque>

#include "device/rml1/point.h"

namespace axisgate::rml1 {

// One way of driving, on one clock. Moves may come before their bytes: they wait for them.
class Planner {
 public:
  // mm/s2; how far a corner may be cut, in mm; how many times as long each move takes.
  Planner(double acceleration, double corner_mm, double slower = 1)
      : acceleration_(acceleration), corner_mm_(corner_mm), slower_(slower) {}

  // `way` in mm, not nothing; mm/s; seconds from the job's beginning until it can be known to the machine.
  void move(const Point& way, double speed, double arrival);
  void pause(double seconds, double arrival);
  // Seconds from the job's beginning until everything stands.
  double finish();

 private:
  struct Segment {
    double length = 0, speed = 0;  // mm, mm/s
    Point direction;
    double arrival = 0;
    double entry_most = 0;  // the corner's, mm2/s2
    double entry = 0;       // from which it can still stop in time, mm2/s2
  };

  double corner_speed(const Segment& before, const Segment& after) const;  // squared
  void plan_backwards();
  void drive_first();
  double duration(const Segment& segment, double entry, double exit) const;

  // A look ahead of so many moves is far longer than any machine's.
  static constexpr std::size_t kLookAhead = 64;

  double acceleration_;
  double corner_mm_;
  double slower_;
  std::deque<Segment> waiting_;
  double entry_ = 0;  // of the first that waits, mm2/s2
  double clock_ = 0;
};

}  // namespace axisgate::rml1
