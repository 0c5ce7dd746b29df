// One seed from its first byte to rest: what the ordinary seeds, the guards' proofs and axisgate-explore all run.
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
  Habits habits = {};                   // of the callers
  std::set<std::uint64_t> spared = {};  // faults that do not strike, by number
};

struct TrialResult {
  std::optional<std::string> violation;  // nothing: all held
  std::string replay;                    // of a violation
  Duration virtual_time{};
  std::uint64_t exchanges = 0, barriers = 0, faults_drawn = 0;
  std::uint64_t digest = 0;  // digest.h
  std::map<std::string, Wire::ByPhase> faults;
};

TrialResult run(const Trial& trial);

// The same violation, or another, with as few faults as can be found by leaving out halves, quarters and so on. Runs at
// most `runs_max` trials.
Trial shrunk(Trial failing, int runs_max);

}  // namespace axisgate::simulation
