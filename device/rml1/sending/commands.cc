#include "device/rml1/sending/commands.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace axisgate::rml1 {

// !ZM takes a machine coordinate, so Z0 has no effect on the raise (guideline 3-3 !ZM).
std::string raise(const Profile& profile) {
  return fmt::format("!VZ{:g};!ZM{};", profile.speed.z_maximum, std::llround(profile.top));
}

std::string prologue() { return ";^DF;"; }

// DF permits the spindle to turn, so !MC0 follows it.
std::string epilogue(const Profile& profile, bool turning) {
  return fmt::format(";{}^PA;{}!MC0;^DF;!MC0;", turning ? "" : "!MC0;", raise(profile));
}

std::string raise_commands(const Profile& profile, bool may_rest) {
  return fmt::format("{}^PA;{}!MC0;", may_rest ? "!MC0;" : "", raise(profile));
}

std::string abort_commands(const Profile& profile, bool may_rest) {
  return "\x1B.K\x1B.K" + raise_commands(profile, may_rest);
}

// The result is at least `slack` times the `slowest` of move_time().
Duration longest_move(double mm, double mm_per_s, const Profile& profile, double slack) {
  const double seconds = mm / mm_per_s + mm_per_s / profile.acceleration.worst;
  return std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(slack * (1 + profile.acceleration.slower) * seconds));
}

}  // namespace axisgate::rml1
