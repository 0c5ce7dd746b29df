#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, runs every test. The last line is "N passed, M failed"; the
# exit code is 0 only if something passed and nothing failed.
# usage: tests/run.sh [PRESET]     a preset of CMakePresets.json; without one `dev`. For any other (asan, tsan) only the
#                                  C++ tests run.
set -euo pipefail

root="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
preset="${1:-dev}"
case "$preset" in
  dev) build="$root/build" ;;
  *) build="$root/build-$preset" ;;
esac
passed=0
failed=0

count() {
  passed=$((passed + $1))
  failed=$((failed + $2))
}

# The one line at the end, whatever happened before it.
summarise() {
  printf '%d passed, %d failed\n' "$passed" "$failed"
  if ((failed > 0 || passed == 0)); then
    exit 1
  fi
}

# A step without which nothing after it means anything.
require() {
  if ! "$@"; then
    printf 'tests/run.sh: failed: %s\n' "$*" >&2
    count 0 1
    summarise
  fi
}

# A check that is one test.
check() {
  if "$@"; then
    count 1 0
  else
    printf 'tests/run.sh: failed: %s\n' "$*" >&2
    count 0 1
  fi
}

# A program that ends with "N passed, M failed".
check_all() {
  local report="$build/cases.log" code=0 line
  "$@" | tee "$report" || code=$?
  line="$(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$report" | tail -n 1)"
  # shellcheck disable=SC2086  # two numbers
  count ${line:-0 0}
  if ((code != 0)) && [[ "$line" == *" 0" || -z "$line" ]]; then
    count 0 1
  fi
}

# Runs the rest of its arguments under a headline, and says how long they took.
stage() {
  local headline="$1" begun=$SECONDS
  shift
  printf '\n== %s\n' "$headline"
  "$@"
  printf '== %s: %d s\n' "$headline" $((SECONDS - begun))
}

build_all() {
  require cmake --preset "$preset"
  require cmake --build --preset "$preset"
}

main() {
  cd "$root"
  export AXISGATE_BIN="$build/bin"
  if [[ "$preset" == tsan ]]; then
    # A seed runs on one thread, where there is nothing to race with, and 25 times slower than without the sanitizer.
    export AXISGATE_SEEDS="${AXISGATE_SEEDS:-20}"
  else
    # A sample; tests/long.sh runs all.
    export AXISGATE_SEEDS="${AXISGATE_SEEDS:-400}"
  fi
  stage "packages" require "$root/deploy/install-packages.sh"
  stage "build of the preset $preset" build_all
  if [[ "$preset" == dev ]]; then
    stage "tidy" check "$root/tests/tidy/tidy"
    stage "tests of tests" check_all /usr/bin/python3 tests/run_python.py tests/tidy
    stage "tests of the mutations" check_all /usr/bin/python3 tests/run_python.py tests/mutants
    stage "tests of the written jobs" check_all /usr/bin/python3 tests/run_python.py tests/jobs
    stage "tests of the reference page" check_all /usr/bin/python3 tests/run_python.py proto/reference
    stage "tests of the benchmarks" check_all /usr/bin/python3 tests/run_python.py tests/bench
  fi
  stage "C++ tests" check_all /usr/bin/python3 tests/run_cases.py "$build"
  if [[ "$preset" == dev ]]; then
    stage "integration" check_all /usr/bin/python3 tests/run_python.py tests/integration
    stage "attacks, for a moment" check_all /usr/bin/python3 tests/run_python.py tests/attack
    stage "fuzzers, for a moment" check "$root/tests/fuzz.sh"
  fi
  printf '\n'
  summarise
}

main
