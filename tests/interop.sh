#!/usr/bin/env bash
# Proof that foreign clients and tools can use the daemon: installs them, builds a client in each language, and runs
# tests/interop/interop.py, whose last line is "N passed, M failed". The daemon is that of tests/run.sh. Go, Rust, Node,
# Java with Maven and Python must be there; versions of libraries are those that the clients' folders name.
# usage: tests/interop.sh [--if-changed]     with --if-changed not if the same inputs have passed on this machine
set -euo pipefail

name=interop
# shellcheck source=tests/recorded-proof.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/recorded-proof.sh"
built="$repository/build/interop"
packages=(curl libprotobuf-dev nghttp2-client protobuf-compiler protobuf-compiler-grpc python3-grpcio python3-h2
  python3-protobuf python3-venv)

# Clients meet the protocol, the front, and what answers behind it.
input_paths() {
  git -C "$repository" ls-tree -r --name-only HEAD -- proto server/front server/rpc server/api tests/interop \
    tests/interop.sh tests/recorded-proof.sh
}

check_languages() {
  local tool
  for tool in go cargo node npm mvn java; do
    command -v "$tool" >/dev/null || fail "needs $tool"
  done
}

install_packages() {
  if ! dpkg-query --show "${packages[@]}" >/dev/null 2>&1; then
    apt-get update --quiet >/dev/null &&
      DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends "${packages[@]}" >/dev/null
  fi
}

build_daemon() {
  cmake --preset dev >/dev/null &&
    cmake --build --preset dev --target axisgated axisctl axisgate-certificates >/dev/null
}

prove() {
  local language
  check_languages
  cd "$repository"
  timed "apt-get install" install_packages
  timed "the daemon" build_daemon
  for language in python node go java rust; do
    timed "build of the client in $language" "tests/interop/clients/$language/build.sh" "$built/$language"
  done
  timed "build of the suites" tests/interop/suites/build.sh "$built/suites"
  AXISGATE_BIN="$repository/build/bin" timed "rows" /usr/bin/python3 tests/interop/interop.py "$built"
}

recorded_proof "$@"
