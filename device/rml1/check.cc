#include "device/rml1/check.h"

#include <utility>

namespace axisgate::rml1 {

Check::Check(const Profile& profile, CheckOptions options, MachineListener* moves)
    : profile_(profile),
      moves_(moves),
      machine_(profile, options.origin, diagnostics_, *this),
      parser_(profile.dialect, diagnostics_, machine_),
      judge_(profile, options.origin.has_value(), options.stock, std::move(options.others), diagnostics_),
      best_(profile.acceleration.best, profile.acceleration.corner_mm),
      worst_(profile.acceleration.worst, std::nullopt) {}

void Check::feed(std::string_view bytes) {
  if (!g_code_ && !refuse_g_code(bytes)) parser_.feed(bytes);
}

bool Check::refuse_g_code(std::string_view bytes) {
  for (const char c : bytes) {
    if (told_ != JobKind::Told::nothing_yet) break;
    told_ = kind_.take(c);
  }
  g_code_ = told_ == JobKind::Told::g_code;
  if (!g_code_) return false;
  diagnostics_.error(0, kind_.place(), "1-2", [] {
    return "this is G-code, not RML-1: a machine that expects RML-1 may hang until it is switched off";
  });
  return true;
}

void Check::finish() {
  if (!g_code_) {
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
  summary_.cutting_mm += distance * move.cutting_part();
  plane_known_ = plane_known_ || move.row->deed == Deed::home || way.x != 0 || way.y != 0;
  if (plane_known_) {
    summary_.bounds.take(move.from);
    summary_.bounds.take(move.to);
  } else {
    summary_.bounds.z.take(move.to.z);
  }
  best_.move(way, move.speed, arrival(move.end));
  worst_.move(way, move.speed, arrival(move.end));
  judge_.moved(move);
  if (moves_ != nullptr) moves_->moved(move);
}

void Check::turned(double seconds, const Move& beside) {
  pause(seconds);
  if (moves_ != nullptr) moves_->turned(seconds, beside);
}

void Check::spun_up(double seconds) {
  ++summary_.spin_ups;
  pause(seconds);
}

void Check::dwelt(double seconds) { pause(seconds); }

void Check::pause(double seconds) {
  best_.pause(seconds);
  worst_.pause(seconds);
}

void Check::commanded(const Point& target, const Instruction& by) { judge_.commanded(target, machine_.box(), by); }
void Check::lifted(double steps, const Instruction& by) { judge_.lifted(steps, by); }

}  // namespace axisgate::rml1
