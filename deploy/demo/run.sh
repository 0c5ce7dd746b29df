#!/usr/bin/env bash
# The demonstration: homes, moves two axes, runs a double-buffered path of 20 segments, and comes back.
# usage: deploy/demo/run.sh AXISCTL [OPTION]...     the options (--target, --device) go before every verb
# Ends at the first step that fails, names it, and passes its exit code on.
set -euo pipefail

here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
axisctl="${1:?usage: $0 AXISCTL [OPTION]...}"
options=("${@:2}")

step() {
  printf '\n$ axisctl %s\n' "$*"
  local code=0
  "$axisctl" "${options[@]}" "$@" || code=$?
  if ((code != 0)); then
    printf 'demonstration: the step "axisctl %s" failed with exit code %d\n' "$*" "$code" >&2
    exit "$code"
  fi
}

step home
step move 1=+2mm 2=-1mm --relative
step path "$here/path.txt"
step position
