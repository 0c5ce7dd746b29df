# shellcheck shell=bash
# What the demonstrations share. The one that reads this has `axisctl` and `options`.

# Shows a command and runs it. Ends at the first one that fails, names it, and passes its exit code on.
step() {
  printf '\n$ axisctl %s\n' "$*"
  local code=0
  "$axisctl" "${options[@]}" "$@" || code=$?
  if ((code != 0)); then
    printf 'demonstration: the step "axisctl %s" failed with exit code %d\n' "$*" "$code" >&2
    exit "$code"
  fi
}
