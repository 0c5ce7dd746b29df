// Effects of a played job as text, short enough to compare by eye.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "device/rml1/check/check.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {

// Origin with Z from -1050 to 5000 by test_profile(), and X and Y from -10000 to 50500.
inline constexpr jobs::Origin kMidway{100, 100, 50};

inline std::string text(const jobs::Point& p) { return fmt::format("{:g} {:g} {:g}", p.x, p.y, p.z); }

// Returns the ends of the moves.
inline std::vector<std::string> ends(const Played& played) {
  std::vector<std::string> found;
  for (const Move& move : played.moves) found.push_back(text(move.to));
  return found;
}

// Returns diagnostics as text: "error 3 at 6", "warning 0 at 0".
inline std::vector<std::string> told(const std::vector<Diagnostic>& diagnostics) {
  std::vector<std::string> found;
  for (const Diagnostic& one : diagnostics) {
    found.push_back(fmt::format("{} {} at {}", name(one.severity), one.number, one.place.offset));
  }
  return found;
}

// Returns diagnostics as text without the warning about a Z1 of the profile, which most jobs of these tests cause
// (state_judge_test.cc).
inline std::vector<std::string> told_but_z1(const std::vector<Diagnostic>& diagnostics) {
  std::vector<Diagnostic> found;
  for (const Diagnostic& one : diagnostics) {
    if (one.text.find("before it sets Z1") == std::string::npos) found.push_back(one);
  }
  return told(found);
}

// Returns a finished check. `profile` must outlive it.
inline std::unique_ptr<Check> checked(const std::string& job, const Profile& profile, CheckOptions options = {}) {
  auto check = std::make_unique<Check>(profile, std::move(options));
  check->feed(job);
  check->finish();
  return check;
}

}  // namespace axisgate::rml1
