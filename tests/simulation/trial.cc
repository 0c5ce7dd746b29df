#include "tests/simulation/trial.h"

#include <algorithm>
#include <vector>

#include "tests/simulation/callers.h"

namespace axisgate::simulation {

TrialResult run(const Trial& trial) {
  World world(drawn_setup(trial.seed, trial.faults));
  world.wire().spare(trial.spared);
  Callers callers(world, trial.seed, trial.faults.mishaps_an_hour, trial.habits);
  callers.act_for(trial.duration);
  callers.become_stationary();
  TrialResult result;
  if (!world.violations().empty()) {
    result.violation = world.violations().front();
    result.replay = world.replay();
  }
  result.virtual_time = world.now().time_since_epoch();
  result.exchanges = world.exchanges();
  result.barriers = world.barriers();
  result.digest = world.wire().digest().value();
  result.faults_drawn = world.wire().faults_drawn();
  result.faults = world.wire().faults_by_kind();
  return result;
}

Trial shrunk(Trial failing, int runs_max) {
  const std::uint64_t drawn = run(failing).faults_drawn;
  for (std::uint64_t block = std::max<std::uint64_t>(1, drawn / 2); runs_max > 0; block /= 2) {
    for (std::uint64_t first = 0; first < drawn && runs_max > 0; first += block, --runs_max) {
      Trial fewer = failing;
      for (std::uint64_t fault = first; fault < first + block; ++fault) fewer.spared.insert(fault);
      if (fewer.spared != failing.spared && run(fewer).violation) failing = std::move(fewer);
    }
    if (block <= 1) break;
  }
  return failing;
}

}  // namespace axisgate::simulation
