#!/usr/bin/env bash
# Proof of the client packages: each is built and installed as its users get it, passes its own checks and tests, runs
# an example, goes through the scenario of clients/conformance against the real daemon, and notices the mutants. The
# languages run at the same time, because their tests mostly wait. The daemon is that of tests/run.sh. Needs Go, Java with
# Maven, Node with npm, Python and Rust. What Rust compiled once is kept for the next time.
# usage: tests/clients.sh [--if-changed]     with --if-changed not if the same inputs have passed on this machine
set -euo pipefail

name=clients
tests="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
# shellcheck source=tests/recorded-proof.sh
source "$tests/recorded-proof.sh"
built="$repository/build/packages"  # build/clients is CMake's
languages=(python cpp go java node rust)
packages=(mypy protobuf-compiler protobuf-compiler-grpc python3-grpcio python3-numpy python3-protobuf python3-venv)
for language in "${languages[@]}"; do
  # shellcheck source=/dev/null
  source "$tests/clients/$language.sh"
done

# Clients meet the API, and what answers behind it.
input_paths() {
  git -C "$repository" ls-tree -r --name-only HEAD -- proto server/front server/rpc server/api server/proto clients \
    tests/clients.sh tests/clients tests/recorded-proof.sh tests/integration/cables.py tests/integration/programs.py
}

install_packages() {
  if ! dpkg-query --show "${packages[@]}" >/dev/null 2>&1; then
    apt-get update --quiet >/dev/null &&
      DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends "${packages[@]}" >/dev/null
  fi
}

build_daemon() {
  cmake --preset dev >/dev/null &&
    cmake --build --preset dev --target axisgated axisctl axisgate axisgate-certificates axisgate-cpp-runner \
      shrc203-sim >/dev/null
}

test_scenario() {
  clients/python/generate.sh && (cd clients/conformance && /usr/bin/python3 -m unittest discover --pattern '*_test.py')
}

# Runs the scenario with the runner that the arguments start.
conform() {
  clients/conformance/conform.py --transport unix "$@"
}
conform_everywhere() {
  conform "$@" && clients/conformance/conform.py --transport loopback "$@" &&
    clients/conformance/conform.py --transport tls "$@" && clients/conformance/conform.py --mutants "$@"
}

# Runs a user's program against a daemon with a simulated stage.
run_example() {
  clients/conformance/example.py "$@"
}

prove() {
  local language failed=""
  local -A running
  cd "$repository"
  for language in cargo go java mvn npm node; do
    command -v "$language" >/dev/null || fail "needs $language"
  done
  export AXISGATE_BIN="$repository/build/bin"
  timed "apt-get install" install_packages
  timed "the daemon" build_daemon
  timed "the scenario itself" test_scenario
  mkdir -p "$built"
  for language in "${languages[@]}"; do
    "prove_$language" >"$built/$language.log" 2>&1 &
    running[$language]=$!
  done
  for language in "${languages[@]}"; do
    wait "${running[$language]}" || failed+=" $language"
    cat "$built/$language.log"
  done
  [[ -z "$failed" ]] || fail "failed:$failed"
}

recorded_proof "$@"
