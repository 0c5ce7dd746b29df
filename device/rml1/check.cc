#include "device/rml1/check.h"

#include <utility>

namespace axisgate::rml1 {

Check::Check(const Profile& profile, CheckOptions options, MoveListener* moves)
    : profile_(profile),
      moves_(moves),
      origin_known_(options.origin.has_value()),
      machine_(profile, options.origin, diagnostics_, *this),
      parser_(profile.dialect, diagnostics_, machine_),
      judge_(profile, origin_known_, options.stock, std::move(options.others), diagnostics_),
      best_(profile.acceleration.best, profile.acceleration.corner_mm),
      worst_(profile.acceleration.worst, std::nullopt, 1 + profile.acceleration.slower) {}

void Check::feed(std::string_view bytes) {
  if (told_ == JobKind::Told::nothing_yet) bytes = recognise(bytes);
  if (!is_g_code()) parser_.feed(bytes);
}

// What is left of the bytes when the kind is known; until then they are held.
std::string_view Check::recognise(std::string_view bytes) {
  std::size_t count = 0;
  while (told_ == JobKind::Told::nothing_yet && count < bytes.size()) told_ = kind_.take(bytes[count++]);
  held_ += bytes.substr(0, count);
  if (is_g_code()) {
    diagnostics_.error(0, kind_.place(), "1-2", [] {
      return "this is G-code, not RML-1: a machine that expects RML-1 may hang until it is switched off";
    });
  } else if (told_ == JobKind::Told::rml) {
    parser_.feed(std::exchange(held_, {}));
  }
  return bytes.substr(count);
}

void Check::finish() {
  if (!is_g_code()) {
    parser_.feed(held_);
    parser_.finish();
    judge_.finish(machine_);
  }
  summary_.final = machine_.tool();
  summary_.seconds_low = best_.finish();
  summary_.seconds_high = worst_.finish();
  summary_.commands = parser_.commands();
}

// Eight bits, a start bit and a stop bit.
double Check::arrival(std::uint64_t end) const {
  return profile_.baud ? static_cast<double>(end) * 10 / *profile_.baud : 0;
}

void Check::moved(const Move& move) {
  const Point way = (move.to - move.from) * profile_.step_mm;
  const double distance = length(way);
  summary_.distance_mm += distance;
  if (move.cuts() && move.turning) summary_.rpm.take(machine_.rpm());
  summary_.cutting_mm += distance * move.cutting_part();
  plane_known_ = plane_known_ || move.deed == Deed::home || way.x != 0 || way.y != 0;
  if (plane_known_) {
    summary_.bounds.take(move.from);
    summary_.bounds.take(move.to);
  } else {
    summary_.bounds.z.take(move.to.z);
  }
  if (!is_assumed(move)) best_.move(way, move.speed, arrival(move.end));
  begun_ = true;
  worst_.move(way, move.speed, arrival(move.end));
  judge_.moved(move);
  if (moves_ != nullptr) moves_->moved(move);
}

// Where Z0 is not known, nobody knows from how high the tool comes down at first.
bool Check::is_assumed(const Move& move) const {
  return !begun_ && !origin_known_ && move.from.x == move.to.x && move.from.y == move.to.y;
}

void Check::waited(Wait what, double seconds, std::uint64_t end) {
  if (what == Wait::spin_up) ++summary_.spin_ups;
  best_.pause(seconds, arrival(end));
  worst_.pause(seconds, arrival(end));
}

void Check::commanded(const Point& target, bool height_alone, const Instruction& by) {
  judge_.commanded(target, height_alone, machine_.box(), by);
}

void Check::lifted(double steps, const Instruction& by) { judge_.lifted(steps, by); }

}  // namespace axisgate::rml1
