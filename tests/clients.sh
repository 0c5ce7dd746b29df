#!/usr/bin/env bash
# Proof of the client packages: each is built as its users get it, passes its own checks and tests, and goes through the
# scenario of clients/conformance against the real daemon. The languages run at the same time, because their tests mostly
# wait. The daemon is that of tests/run.sh. Needs Go, Node with npm, and Python.
# usage: tests/clients.sh [--if-changed]     with --if-changed not if the same inputs have passed on this machine
set -euo pipefail

name=clients
# shellcheck source=tests/recorded-proof.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/recorded-proof.sh"
built="$repository/build/clients"
languages=(python go node)
packages=(mypy protobuf-compiler protobuf-compiler-grpc python3-grpcio python3-numpy python3-protobuf python3-venv)

# Clients meet the API, and what answers behind it.
input_paths() {
  git -C "$repository" ls-tree -r --name-only HEAD -- proto server/front server/rpc server/api server/proto clients \
    tests/clients.sh tests/recorded-proof.sh tests/integration/cables.py tests/integration/programs.py
}

install_packages() {
  if ! dpkg-query --show "${packages[@]}" >/dev/null 2>&1; then
    apt-get update --quiet >/dev/null &&
      DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends "${packages[@]}" >/dev/null
  fi
}

build_daemon() {
  cmake --preset dev >/dev/null &&
    cmake --build --preset dev --target axisgated axisctl axisgate-certificates shrc203-sim >/dev/null
}

# Runs the scenario with the runner that the arguments start.
conform() {
  clients/conformance/conform.py --transport unix "$@"
}
conform_everywhere() {
  conform "$@" && clients/conformance/conform.py --transport loopback "$@" &&
    clients/conformance/conform.py --transport tls "$@"
}

# With Debian's libraries, the oldest ones that the package supports.
check_python() {
  clients/python/generate.sh && (cd clients/python && mypy --no-error-summary src)
}
test_python() {
  (cd clients/python/tests && PYTHONPATH=../src /usr/bin/python3 -m unittest discover --pattern '*_test.py')
}

# Makes the wheel, and installs it into an empty environment, with the newest libraries.
install_python() {
  rm -rf "$built/python" && mkdir -p "$built/python" &&
    python3 -m venv "$built/python/venv" &&
    "$built/python/venv/bin/pip" install --quiet --disable-pip-version-check build &&
    "$built/python/venv/bin/python" -m build --outdir "$built/python/dist" clients/python >/dev/null &&
    python3 -m venv --clear "$built/python/venv" &&
    "$built/python/venv/bin/pip" install --quiet --disable-pip-version-check "$built"/python/dist/*.whl
}

prove_python() {
  local debian=(env PYTHONPATH=clients/python/src /usr/bin/python3)
  timed "python: generated code, mypy" check_python
  timed "python: tests" test_python
  timed "python: scenario" conform_everywhere "${debian[@]}" clients/python/conformance/runner.py
  timed "python: scenario, asyncio" conform "${debian[@]}" clients/python/conformance/aio_runner.py
  timed "python: wheel, sdist" install_python
  timed "python: scenario, newest libraries" conform "$built/python/venv/bin/python" clients/python/conformance/runner.py
}

check_go() {
  clients/go/generate.sh --check &&
    (cd clients/go && test -z "$(gofmt -l .)" && go vet ./... && go build -o "$built/go/runner" ./internal/conformance)
}
test_go() {
  (cd clients/go && go test -count=1 ./...)  # the daemon is no input that Go sees
}

prove_go() {
  timed "go: generated code, gofmt, vet" check_go
  timed "go: tests" test_go
  timed "go: scenario" conform_everywhere "$built/go/runner"
}

check_node() {
  (cd clients/node && npm ci --no-audit --no-fund --loglevel=error >/dev/null && npm run --silent build &&
    npm run --silent lint)
}
test_node() {
  (cd clients/node && npm test --silent)
}

prove_node() {
  timed "node: build, prettier, eslint" check_node
  timed "node: tests" test_node
  timed "node: scenario" conform_everywhere clients/node/conformance/runner.mjs
}

prove() {
  local language failed=""
  local -A running
  cd "$repository"
  for language in go npm node; do
    command -v "$language" >/dev/null || fail "needs $language"
  done
  export AXISGATE_BIN="$repository/build/bin"
  timed "apt-get install" install_packages
  timed "the daemon" build_daemon
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
