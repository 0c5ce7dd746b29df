#include "device/rml1/simulator/drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "device/rml1/simulator/seconds.h"

namespace axisgate::rml1::simulator {
namespace {

double acceleration(const MillSetup& setup) {
  if (setup.options.is("acceleration", "best")) return setup.profile.acceleration.best;
  if (setup.options.is("acceleration", "worst")) return setup.profile.acceleration.worst;
  return 0;
}

}  // namespace

Drive::Drive(const MillSetup& setup, SpindleMotor& spindle, Record& record)
    : setup_(setup), spindle_(spindle), record_(record) {}

void Drive::move(const Position& to, double mm_per_s) {
  if (to == planned_) return;
  queue_.push_back({.kind = Work::Kind::move, .to = to, .mm_per_s = mm_per_s});
  planned_ = to;
}

void Drive::turn(double degrees, double degrees_per_s) {
  planned_angle_ += degrees;
  queue_.push_back(
      {.kind = Work::Kind::turn, .degrees = degrees, .time = from_seconds(std::abs(degrees) / degrees_per_s)});
}

void Drive::dwell(Duration time) {
  if (time > Duration::zero()) queue_.push_back({.kind = Work::Kind::dwell, .time = time});
}

void Drive::start_spindle() { queue_.push_back({.kind = Work::Kind::spin_up}); }

void Drive::stop_spindle() { queue_.push_back({.kind = Work::Kind::stop_spindle}); }

void Drive::run(TimePoint now) {
  TimePoint at = now;
  while (begin_next(at)) {
    const TimePoint end = running_->began + running_->time;
    if (end > now) return;
    record_.at(end);
    finish(*std::exchange(running_, std::nullopt));
    at = end;
  }
}

// Returns false if there is nothing to do.
bool Drive::begin_next(TimePoint now) {
  if (running_) return true;
  const bool interlude = !interlude_.empty();
  std::deque<Work>& from = interlude ? interlude_ : queue_;
  if (from.empty() || (pause_ && !interlude)) return false;
  const Work next = from.front();
  from.pop_front();
  begin(next, interlude, now);
  return true;
}

void Drive::begin(const Work& work, bool interlude, TimePoint now) {
  const Travel travel = work.kind == Work::Kind::move ? travel_to(work) : Travel{};
  running_ = Running{work, interlude, tool_, now, travel, time_of(work, travel)};
}

Duration Drive::time_of(const Work& work, const Travel& travel) {
  switch (work.kind) {
    case Work::Kind::move:
      return from_seconds(travel.seconds());
    case Work::Kind::turn:
      return from_seconds(in_seconds(work.time) * slower());
    case Work::Kind::dwell:
      return work.time;
    case Work::Kind::spin_up:
      return spindle_.start() ? from_seconds(setup_.profile.spindle.spin_up_s) : Duration::zero();
    case Work::Kind::stop_spindle:
      return Duration::zero();
  }
  return Duration::zero();
}

Travel Drive::travel_to(const Work& work) const {
  const double step = setup_.profile.step_mm;
  const double rise = std::abs(work.to.h - tool_.h) * step;
  const double all = std::hypot((work.to.x - tool_.x) * step, (work.to.y - tool_.y) * step, rise);
  // Z's own limit slows down the other axes, too.
  const double limit = rise > 0 ? setup_.profile.speed.travel_z * all / rise : work.mm_per_s;
  return {all, std::min(work.mm_per_s, limit), acceleration(setup_), slower()};
}

double Drive::slower() const { return 1 + setup_.slower_percent / 100; }

void Drive::finish(const Running& done) {
  if (done.interlude && interlude_.empty()) returning_.reset();
  switch (done.work.kind) {
    case Work::Kind::move:
      tool_ = done.work.to;
      return record_.path(done.began, done.from, tool_);
    case Work::Kind::turn:
      return turned(done.work.degrees);
    case Work::Kind::dwell:
      return record_.wait("dwell", done.time);
    case Work::Kind::spin_up:
      if (done.time > Duration::zero()) record_.wait("spin-up", done.time);
      return;
    case Work::Kind::stop_spindle:
      return spindle_.stop();
  }
}

Drive::Work Drive::vertical(const Position& to) const {
  return {.kind = Work::Kind::move, .to = to, .mm_per_s = setup_.profile.speed.travel_z};
}

std::optional<TimePoint> Drive::next() const {
  return running_ ? std::optional(running_->began + running_->time) : std::nullopt;
}

bool Drive::idle() const { return !running_ && queue_.empty() && interlude_.empty() && !pause_; }

Position Drive::tool(TimePoint now) const {
  if (!running_ || running_->work.kind != Work::Kind::move) return tool_;
  const double part = running_->travel.part_after(in_seconds(now - running_->began));
  const Position& to = running_->work.to;
  const auto between = [part](double from, double end) { return from + (end - from) * part; };
  return {between(tool_.x, to.x), between(tool_.y, to.y), between(tool_.h, to.h)};
}

// Interrupts the work in progress. Its rest becomes the first item of the queue again, unless it belongs to a pause.
void Drive::interrupt(TimePoint now) {
  if (!running_) return;
  const Position reached = tool(now);
  const Running cut = *std::exchange(running_, std::nullopt);
  Work rest = cut.work;
  if (rest.kind == Work::Kind::move) {
    tool_ = reached;
    record_.path(cut.began, cut.from, tool_);
  } else if (cut.time > Duration::zero()) {
    const double left = 1 - in_seconds(now - cut.began) / in_seconds(cut.time);
    if (rest.kind == Work::Kind::turn) turned(rest.degrees * (1 - left));
    rest.degrees *= left;
    rest.time = from_seconds(in_seconds(rest.time) * left);
  }
  if (!cut.interlude) queue_.push_front(rest);
}

void Drive::end(TimePoint now) {
  interrupt(now);
  interlude_.clear();
  queue_.clear();
  pause_.reset();
  returning_.reset();
  planned_ = tool_;
  planned_angle_ = angle_;
}

void Drive::turned(double degrees) {
  angle_ += degrees;
  record_.turn(degrees);
}

void Drive::pause(TimePoint now) {
  if (pause_) return;
  interrupt(now);
  interlude_.clear();
  pause_ = returning_.value_or(Pause{tool_, spindle_.rotates()});
  returning_.reset();
  spindle_.stop();
  const Position top{tool_.x, tool_.y, 0};
  if (setup_.options.is("pause_position", "top") && top != tool_) interlude_.push_back(vertical(top));
}

void Drive::resume(TimePoint now) {
  if (!pause_) return;
  interrupt(now);
  interlude_.clear();
  const Pause pause = *std::exchange(pause_, std::nullopt);
  if (pause.spindle) interlude_.push_back({.kind = Work::Kind::spin_up});
  if (tool_ != pause.tool) interlude_.push_back(vertical(pause.tool));
  if (!interlude_.empty()) returning_ = pause;
}

}  // namespace axisgate::rml1::simulator
