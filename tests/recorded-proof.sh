# shellcheck shell=bash
# For the slow proofs, which source this. What passed is kept outside the tree, by the hash of its inputs: with
# --if-changed a proof whose inputs have passed on this machine is not run again. The file that sources this says what it
# is:
#   name           as in messages
#   input_paths    those of HEAD that decide whether it passes
#   prove          the proof itself; returns only if it passed
# shellcheck disable=SC2154  # name is the sourcing file's
repository="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
passed_folder="${XDG_CACHE_HOME:-$HOME/.cache}/axisgate/passed"

fail() {
  printf '%s: %s\n' "$name" "$*" >&2
  exit 1
}

# Taken from HEAD, as the proofs do: uncommitted changes are not what passed.
inputs_hash() {
  input_paths | xargs git -C "$repository" ls-tree -r HEAD -- | sha256sum | cut -d ' ' -f 1
}

# Installs what of its arguments, programs named as their packages, is missing.
install_tools() {
  local tool
  for tool in "$@"; do
    if ! command -v "$tool" >/dev/null; then
      apt-get update --quiet >/dev/null &&
        DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends "$@" >/dev/null
      return
    fi
  done
}

# The mirror is the one that this machine's apt uses.
debian_sources() {
  # shellcheck disable=SC2016  # the dollar signs are apt's
  apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
    grep ' bookworm' | sort -u || fail "this machine's apt names no Debian 12 mirror; run apt-get update first"
}

timed() {
  local label="$1" start=$SECONDS
  shift
  "$@" || fail "failed: $label"
  printf '== %s: %s took %d s\n' "$name" "$label" $((SECONDS - start))
}

recorded_proof() {
  local inputs
  inputs="$(inputs_hash)"
  if [[ "${1-}" == --if-changed && -f "$passed_folder/$name-$inputs" ]]; then
    printf '%s: its inputs passed on this machine with commit %s\n' "$name" "$(<"$passed_folder/$name-$inputs")"
    return 0
  fi
  prove
  mkdir -p "$passed_folder"
  git -C "$repository" rev-parse HEAD >"$passed_folder/$name-$inputs"
  printf '%s: passed\n' "$name"
}
