#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, runs every test. The last line is "N passed, M failed"; the
# exit code is 0 only if something passed and nothing failed.
# usage: tests/run.sh [PRESET]     a preset of CMakePresets.json; without one `dev`. Any other (asan, tsan) builds into
#                                  build-PRESET and runs the C++ tests alone.
set -euo pipefail

root="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
preset="${1:-dev}"
build="$root/build-$preset"
passed=0
failed=0

say() {
  printf '\n== %s\n' "$*"
}

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

build_all() {
  say "configure and build the preset $preset"
  require cmake --preset "$preset"
  require cmake --build --preset "$preset"
}

# The number that stands in attribute $1 of the report's first element.
junit_number() {
  local number
  number="$(sed -n '/<testsuite /,/>/s/.*[[:space:]]'"$1"'="\([0-9]*\)".*/\1/p' "$build/ctest.xml" | head -n 1)"
  printf '%s' "${number:-0}"
}

run_ctest() {
  say "C++ tests"
  local code=0 tests failures skipped
  rm -f "$build/ctest.xml"
  ctest --test-dir "$build" --parallel "$(nproc)" --output-on-failure --no-tests=error \
    --output-junit "$build/ctest.xml" || code=$?
  if [[ ! -s "$build/ctest.xml" ]]; then
    count 0 1
    return
  fi
  tests="$(junit_number tests)"
  failures="$(junit_number failures)"
  skipped=$(($(junit_number skipped) + $(junit_number disabled)))
  # ctest may fail for a reason that is no test's.
  if ((code != 0 && failures == 0)); then
    failures=1
  fi
  count $((tests - failures - skipped)) "$failures"
}

# unittest ends with "OK (skipped=1)" or "FAILED (failures=1, errors=2)"; a kind that is not named is 0.
unittest_number() {
  local number
  number="$(sed -n '/^\(OK\|FAILED\)\( (.*)\)\?$/s/.*[( ]'"$1"'=\([0-9]*\).*/\1/p' "$build/unittest.log" | tail -n 1)"
  printf '%s' "${number:-0}"
}

# Python's unittest over the files of the folder $1.
run_unittest() {
  say "$1"
  local report="$build/unittest.log" code=0 ran bad
  AXISGATE_BIN="$build/bin" PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m unittest discover --verbose \
    --start-directory "$root/$1" --pattern '*.py' 2>&1 | tee "$report" || code=$?
  ran="$(sed -n 's/^Ran \([0-9]*\) tests\? in .*/\1/p' "$report" | tail -n 1)"
  bad=$(($(unittest_number failures) + $(unittest_number errors) + $(unittest_number 'unexpected successes')))
  # A folder that cannot be loaded, or in which nothing ran, has failed, too.
  if ((code != 0 && bad == 0)) || ((${ran:-0} == 0)); then
    count 0 1
    return
  fi
  count $((ran - bad - $(unittest_number skipped))) "$bad"
}

main() {
  cd "$root"
  if [[ "$preset" == tsan ]]; then
    # A seed runs on one thread, where there is nothing to race with, and 25 times slower than without the sanitizer.
    export AXISGATE_SEEDS="${AXISGATE_SEEDS:-20}"
  fi
  require "$root/deploy/install-packages.sh"
  build_all
  if [[ "$preset" == dev ]]; then
    say "tidy"
    check "$root/tests/tidy/tidy"
    run_unittest tests/tidy
  fi
  run_ctest
  if [[ "$preset" == dev ]]; then
    run_unittest tests/integration
    say "fuzzers, for a moment"
    check "$root/tests/fuzz.sh"
  fi
  printf '\n'
  summarise
}

main
