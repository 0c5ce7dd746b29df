#!/usr/bin/env bash
# The demonstration of a stage: homes, moves two axes, runs a double-buffered path of 20 segments, and comes back.
# usage: deploy/demo/run.sh AXISCTL [OPTION]...     the options (--target, --device) go before every verb
set -euo pipefail

here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
axisctl="${1:?usage: $0 AXISCTL [OPTION]...}"
options=("${@:2}")
# shellcheck source=deploy/demo/steps.sh
source "$here/steps.sh"

step home
step move 1=+2mm 2=-1mm --relative
step path "$here/path.txt"
step position
