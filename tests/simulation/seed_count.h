// Number of seeds in a run.
#pragma once

#include <cstdlib>

namespace axisgate::simulation {

// Returns AXISGATE_SEEDS, or `ordinary` without it. AXISGATE_SEED runs one seed, in the first case.
inline int seed_count(int ordinary) {
  const char* limit = std::getenv("AXISGATE_SEEDS");
  return limit != nullptr ? std::atoi(limit) : ordinary;
}

// Returns the number of cases of `seeds_a_case` seeds each.
inline int seed_cases(int ordinary, int seeds_a_case) {
  return (seed_count(ordinary) + seeds_a_case - 1) / seeds_a_case;
}

}  // namespace axisgate::simulation
