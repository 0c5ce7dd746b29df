#!/usr/bin/env bash
# Proof that a line of 38400 baud feeds a path of 60 ms segments while all ask, over a pty in real time: 1,000 segments
# take a minute, 10,000 ten. Needs what tests/run.sh has built.
# usage: tests/paced-path.sh SEGMENTS
set -euo pipefail

root="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"

AXISGATE_SEGMENTS="${1:?how many segments?}" AXISGATE_BIN="${AXISGATE_BIN:-$root/build/bin}" \
  PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$root/tests/integration/paced_path_test.py"
