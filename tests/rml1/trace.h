// What came of a played job, short enough to be compared by eye.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "device/rml1/check/check.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {

// Z from -1050 to 5000 with test_profile(), X and Y from -10000 to 50500.
inline constexpr Origin kMidway{100, 100, 50};

inline std::string text(const Point& p) { return fmt::format("{:g} {:g} {:g}", p.x, p.y, p.z); }

// Where the moves end.
inline std::vector<std::string> ends(const Played& played) {
  std::vector<std::string> found;
  for (const Move& move : played.moves) found.push_back(text(move.to));
  return found;
}

// "error 3 at 6", "warning 0 at 0".
inline std::vector<std::string> told(const std::vector<Diagnostic>& diagnostics) {
  std::vector<std::string> found;
  for (const Diagnostic& one : diagnostics) {
    found.push_back(fmt::format("{} {} at {}", name(one.severity), one.number, one.place.offset));
  }
  return found;
}

// The same without the warning of a Z1 that the profile has given, as it does in most jobs of these tests
// (state_judge_test.cc).
inline std::vector<std::string> told_but_z1(const std::vector<Diagnostic>& diagnostics) {
  std::vector<Diagnostic> found;
  for (const Diagnostic& one : diagnostics) {
    if (one.text.find("before it sets Z1") == std::string::npos) found.push_back(one);
  }
  return told(found);
}

// `profile` outlives what comes back.
inline std::unique_ptr<Check> checked(const std::string& job, const Profile& profile, CheckOptions options = {}) {
  auto check = std::make_unique<Check>(profile, std::move(options));
  check->feed(job);
  check->finish();
  return check;
}

}  // namespace axisgate::rml1
