// One seed from its first byte until everything is stationary. The ordinary seeds, the tests of guards and
// axisgate-explore all run trials.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "tests/simulation/callers.h"
#include "tests/simulation/world.h"

namespace axisgate::simulation {

struct Trial {
  std::uint64_t seed = 0;
  Faults faults = Faults::hostile();
  Duration duration = std::chrono::minutes(10);
  Habits habits = {};                   // habits of the callers
  std::set<std::uint64_t> spared = {};  // numbers of the faults that do not strike
};

struct TrialResult {
  std::optional<std::string> violation;  // nullopt if there was no violation
  std::string replay;                    // replay of the violation
  Duration virtual_time{};
  std::uint64_t exchanges = 0, barriers = 0, faults_drawn = 0;
  std::uint64_t digest = 0;  // digest.h
  std::map<std::string, Wire::ByPhase> faults;
};

TrialResult run(const Trial& trial);

// Returns a trial with the same or another violation and as few faults as leaving out halves, quarters and so on can
// find. Runs at most `runs_max` trials.
Trial shrunk(Trial failing, int runs_max);

}  // namespace axisgate::simulation
