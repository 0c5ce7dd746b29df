#!/usr/bin/env bash
# Proof that the API's files are as their tools want them: `buf lint` and `buf format`, that they break no program of the
# recorded baseline (`buf breaking`), and that the options of each file carry the names of clients/names. Needs node and
# npm; buf's version is that of tests/buf.
# usage: tests/buf.sh [--if-changed]     with --if-changed not if the same inputs have passed on this machine
set -euo pipefail

name=buf
# shellcheck source=tests/recorded-proof.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/recorded-proof.sh"
built="$repository/build/buf"
baseline=tests/buf/baseline.binpb  # buf build --exclude-source-info

input_paths() {
  git -C "$repository" ls-tree -r --name-only HEAD -- proto clients/names tests/buf tests/buf.sh tests/recorded-proof.sh
}

install_buf() {
  mkdir -p "$built" && cp "$repository"/tests/buf/*.json "$built" &&
    npm ci --prefix "$built" --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null
}

# Prints the value of a key of clients/names.
value_of() {
  sed -n "s/^$1 = //p" "$repository/clients/names"
}

check_names() {
  local file option
  option="option go_package = \"$(value_of go_module)/axisgate/v1;axisgatev1\";"
  for file in "$repository"/proto/axisgate/v1/*.proto; do
    grep -qxF "$option" "$file" || fail "${file#"$repository/"} lacks: $option"
    grep -qxF "option java_package = \"$(value_of maven_group).v1\";" "$file" ||
      fail "${file#"$repository/"}: java_package does not begin with the group of clients/names"
  done
}

# A commit that changes both could hide a broken API behind a new baseline.
check_baseline() {
  local commit
  while read -r commit; do
    [[ -z "$(git -C "$repository" show --name-only --format= "$commit" -- proto/axisgate)" ]] ||
      fail "commit $commit changes the API and its baseline"
  done < <(git -C "$repository" log --format=%h -- "$baseline")
}

prove() {
  local buf="$built/node_modules/.bin/buf"
  timed "npm ci" install_buf
  check_names
  check_baseline
  cd "$repository/proto"
  "$buf" lint || fail "buf lint"
  "$buf" breaking --against "$repository/$baseline" || fail "buf breaking: programs of the baseline would not work"
  "$buf" format --diff --exit-code || fail "buf format: run \`buf format -w\` in proto/"
}

recorded_proof "$@"
