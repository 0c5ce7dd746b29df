// Jobs of short vectors, like reliefs of CAM programs: 18 bytes per command, 18.75 ms on a line of 9600 baud.
#pragma once

#include <fmt/format.h>

#include <string>

#include "device/rml1/sending/commands.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {

// Work origin at the place where the simulator begins, so that nothing is clipped.
inline constexpr jobs::Origin kAtHome{0, 0, 0};

// Returns a profile with accelerations and a slower high end, like the shipped profiles.
inline Profile short_vectors_profile() {
  Profile profile = test_profile();
  profile.acceleration = {.best = 200, .worst = 100, .slower = 0.5};
  return profile;
}

// Returns the profile of a mill whose figures were measured, and which needs no time to accelerate.
inline Profile measured_profile() {
  Profile profile = test_profile();
  profile.acceleration = {.best = 1e7, .worst = 1e7, .slower = 0};
  return profile;
}

// Returns rows of 40,000 steps, to the right and back, at 10 mm/s. `steps(index)` is the length of a vector, in 0.01
// mm.
template <class Steps>
std::string vectors(int count, Steps&& steps) {
  std::string job = prologue() + "!MC0;V10;\n";
  int x = 10'000, y = 10'000, way = 1;
  for (int index = 0; index < count; ++index) {
    if (x + way * steps(index) > 50'000 || x + way * steps(index) < 10'000) way = -way;
    x += way * steps(index);
    y += index % 1000 == 0 ? 20 : 0;
    job += fmt::format("Z{},{},-100\n", x, y);
  }
  return job + epilogue(short_vectors_profile(), false);
}

// Returns vectors that take 20 ms each at full speed.
inline std::string uniform_vectors(int count) {
  return vectors(count, [](int) { return 20; });
}

// Returns bursts: one vector of 400 ms, then twenty of 8 ms.
inline std::string bursts_of_vectors(int count) {
  return vectors(count, [](int index) { return index % 21 == 0 ? 400 : 8; });
}

}  // namespace axisgate::rml1
