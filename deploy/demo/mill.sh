#!/usr/bin/env bash
# The demonstration of a mill: a small job from the queue to the finished workpiece. Only for a simulated mill: it
# confirms what a person at the mill should have seen, and frame.rml sets Z0 by itself, 5 mm below the top.
# usage: deploy/demo/mill.sh AXISCTL [OPTION]...     the options (--target, --device) go before every verb
set -euo pipefail

here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
axisctl="${1:?usage: $0 AXISCTL [OPTION]...}"
options=("${@:2}")
# shellcheck source=deploy/demo/steps.sh
source "$here/steps.sh"

# Of the first job that waits: the only one that a new daemon has.
job_number() {
  "$axisctl" "${options[@]}" mill queue | awk '/^[0-9]/ && !n++ { print $1 }'
}

step mill send "$here/frame.rml" --origin vice
step mill queue
step mill confirm --yes
step mill start --follow
step mill done "$(job_number)"
step --device mill history
