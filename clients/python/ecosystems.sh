#!/usr/bin/env bash
# Tests the devices for bluesky, ophyd-async and PyMoDAQ with these libraries, which it installs. Needs Python 3.11 or
# later, the programs of the daemon in the folder AXISGATE_BIN, and an index of packages. Takes 5 minutes, and up to
# 3 more for the first installation.
# usage: ecosystems.sh FOLDER     FOLDER receives an environment of 1.2 GB; an existing one is used again
set -euo pipefail

[[ $# == 1 ]] || { sed -n '2,5s/^# //p' "$0" >&2; exit 2; }
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
mkdir -p "$1"
folder="$(readlink -f "$1")"
python="$folder/venv/bin/python"
AXISGATE_BIN="$(readlink -f "${AXISGATE_BIN:-$here/../../build/bin}")"
export AXISGATE_BIN

# PySide6 6.12.0 does not work with PyMoDAQ 5.
packages=('bluesky>=1.15,<2' 'ophyd-async>=0.21,<0.22' 'pymodaq>=5.3,<6' 'PySide6!=6.12.0')

# Copies the sources, because a build writes into its folder.
install_from() {
  rm -rf "$folder/source" && cp -r "$1" "$folder/source" &&
    "$python" -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall "$folder/source"
}

[[ -x "$python" ]] || "${PYTHON:-python3}" -m venv "$folder/venv"
"$python" -m pip install --quiet --disable-pip-version-check "${packages[@]}" 'grpcio>=1.51.1' 'protobuf>=4.21.12'
install_from "$here"
install_from "$here/pymodaq"

cd "$here/tests"
for test in bluesky ophyd_async ophyd_async_mock pymodaq pymodaq_scan; do
  start=$SECONDS
  if ! QT_QPA_PLATFORM=offscreen "$python" -m unittest "${test}_test" >"$folder/$test.log" 2>&1; then
    cat "$folder/$test.log" >&2
    printf 'failed: %s\n' "$test" >&2
    exit 1
  fi
  if grep -q 'skipped=' "$folder/$test.log"; then
    printf 'failed: %s was skipped\n' "$test" >&2
    exit 1
  fi
  printf '%s: %s in %d s\n' "$test" "$(grep -o 'Ran [0-9]* tests*' "$folder/$test.log")" $((SECONDS - start))
done
