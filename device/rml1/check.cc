#include "device/rml1/check.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace axisgate::rml1 {
namespace {

// "12 s", "3 min 5 s", "2 h 10 min"
std::string duration(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string time_text(const Summary& summary) {
  return duration(summary.seconds_low) + " to " + duration(summary.seconds_high);
}

Check::Check(const Profile& profile, CheckOptions options, MoveListener* moves)
    : profile_(profile),
      moves_(moves),
      origin_known_(options.origin.has_value()),
      machine_(profile, options.origin, diagnostics_, *this),
      parser_(profile.dialect, diagnostics_, machine_),
      judge_(profile, origin_known_, options.stock, std::move(options.others), diagnostics_),
      best_(profile.acceleration.best, profile.acceleration.corner_mm),
      worst_(profile.acceleration.worst, profile.acceleration.corner_mm, 1 + profile.acceleration.slower) {}

void Check::feed(std::string_view bytes) {
  if (verdict_ == JobKind::Verdict::nothing_yet) bytes = recognise(bytes);
  if (!is_g_code()) parser_.feed(bytes);
}

// What is left of the bytes when the kind is known; until then they are held.
std::string_view Check::recognise(std::string_view bytes) {
  std::size_t count = 0;
  while (verdict_ == JobKind::Verdict::nothing_yet && count < bytes.size()) verdict_ = kind_.take(bytes[count++]);
  held_ += bytes.substr(0, count);
  if (is_g_code()) {
    diagnostics_.error(0, kind_.place(), "1-2", [] {
      return "this is G-code, not RML-1: a machine that expects RML-1 may hang until it is switched off";
    });
  } else if (verdict_ == JobKind::Verdict::rml) {
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
  const bool assumed = begins_assumed(move);
  summary_.bounds.take(assumed ? move.to : move.from);
  summary_.bounds.take(move.to);
  if (!assumed) best_.move(way, move.speed, arrival(move.end));
  begun_ = true;
  worst_.move(way, move.speed, arrival(move.end));
  judge_.moved(move);
  if (moves_ != nullptr) moves_->moved(move);
}

// Where Z0 is not known, nobody knows from how high the tool comes down at first.
bool Check::begins_assumed(const Move& move) const {
  return !begun_ && !origin_known_ && move.from.x == move.to.x && move.from.y == move.to.y;
}

void Check::waited(Wait what, double seconds, std::uint64_t end) {
  if (what == Wait::spin_up) ++summary_.spin_ups;
  best_.pause(seconds, arrival(end));
  worst_.pause(seconds, arrival(end));
}

void Check::commanded(const Point& from, const Point& target, bool height_alone, const Instruction& by) {
  judge_.commanded(from, target, height_alone, machine_.box(), by);
}

void Check::lifted(double steps, const Instruction& by) { judge_.lifted(steps, by); }

}  // namespace axisgate::rml1
