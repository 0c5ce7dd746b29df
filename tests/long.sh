#!/usr/bin/env bash
# The proofs that take too long for every change: seeds never run before, all the seeds of which tests/run.sh takes a
# sample, the journal's log damaged at every byte, a paced path of ten minutes, both fuzzers, and the devices for
# bluesky, ophyd-async and PyMoDAQ.
# usage: tests/long.sh [HOURS]     virtual hours of hostile seeds, 100 without
set -euo pipefail

root="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
hours="${1:-100}"
fuzz_seconds=300
paced_segments=10000

main() {
  cd "$root"
  "$root/deploy/install-packages.sh"
  cmake --preset dev
  cmake --build --preset dev
  # The day tells the seeds, so that each day runs others, and a failure can be run again by its number.
  local first
  first="$(date +%Y%m%d)0000"
  printf '== seeds from %s on\n' "$first"
  build/bin/axisgate-explore --seed "$first" --seeds "$((hours * 6))" --hours "$hours"
  build/bin/axisgate-explore --seed "$((first + 5000))" --seeds "$((hours * 2))" --hours "$((hours / 3))" --shapes
  AXISGATE_SEEDS=1000 /usr/bin/python3 tests/run_cases.py build simulation
  AXISGATE_SEEDS=20000 build/bin/rml1_tests --gtest_filter='*MillSeeds.*'
  AXISGATE_EVERY_BYTE=1 build/bin/unit_tests --gtest_filter='JournalDamage.ALog*'
  "$root/tests/paced-path.sh" "$paced_segments"
  "$root/tests/fuzz.sh" "$fuzz_seconds"
  "$root/clients/python/ecosystems.sh" "$root/build/ecosystems"
}

main
