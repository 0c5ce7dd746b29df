#include "device/rml1/planner.h"

#include <algorithm>
#include <cmath>

namespace axisgate::rml1 {

void Planner::move(const Point& way, double speed, double arrival) {
  Segment segment;
  segment.length = length(way);
  segment.speed = speed;
  segment.direction = way * (1 / segment.length);
  segment.arrival = arrival;
  if (!waiting_.empty()) segment.entry_most = corner_speed(waiting_.back(), segment);
  waiting_.push_back(segment);
  plan_backwards();
  if (waiting_.size() > kLookAhead) drive_first();
}

void Planner::pause(double seconds, double arrival) { clock_ = std::max(finish(), arrival) + seconds; }

double Planner::finish() {
  while (!waiting_.empty()) drive_first();
  entry_ = 0;
  return clock_;
}

// The speed at which an arc that cuts the corner by `corner_mm_` can be followed with the acceleration that there is.
double Planner::corner_speed(const Segment& before, const Segment& after) const {
  const Point& a = before.direction;
  const Point& b = after.direction;
  const double cosine = -(a.x * b.x + a.y * b.y + a.z * b.z);  // of the angle between the two legs
  const double half_sine = std::sqrt(std::max(0.0, (1 - cosine) / 2));
  const double slower = std::min(before.speed, after.speed);
  if (half_sine > 0.999999) return slower * slower;
  return std::min(slower * slower, acceleration_ * corner_mm_ * half_sine / (1 - half_sine));
}

// Each must be able to stop before the end of the last. Before the first whose entry stays as it was, all do.
void Planner::plan_backwards() {
  double exit = 0;
  for (auto segment = waiting_.rbegin(); segment != waiting_.rend(); ++segment) {
    const double entry = std::min(segment->entry_most, exit + 2 * acceleration_ * segment->length);
    if (segment != waiting_.rbegin() && entry == segment->entry) return;
    segment->entry = entry;
    exit = entry;
  }
}

void Planner::drive_first() {
  const Segment segment = waiting_.front();
  waiting_.pop_front();
  const double wanted = waiting_.empty() ? 0 : waiting_.front().entry;
  const double exit = std::min(wanted, entry_ + 2 * acceleration_ * segment.length);
  clock_ = std::max(clock_, segment.arrival) + duration(segment, entry_, exit);
  entry_ = exit;
}

// Up to the speed, along, and down again; or only up and down, if the way is too short. Speeds squared.
double Planner::duration(const Segment& segment, double entry, double exit) const {
  const double top = std::min(segment.speed * segment.speed, (entry + exit) / 2 + acceleration_ * segment.length);
  const double fastest = std::sqrt(top);
  const double ramps = (2 * top - entry - exit) / (2 * acceleration_);
  const double changing = (2 * fastest - std::sqrt(entry) - std::sqrt(exit)) / acceleration_;
  return slower_ * (changing + std::max(0.0, segment.length - ramps) / fastest);
}

}  // namespace axisgate::rml1
