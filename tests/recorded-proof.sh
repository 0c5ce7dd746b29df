# shellcheck shell=bash
# For the slow proofs, which source this: each records the commit and the inputs with which it passed last, and with
# --if-changed runs only if its inputs differ from those. The file that sources this says what it is:
#   name           as in messages
#   record         the file that says what passed
#   input_paths    those of HEAD that decide whether it passes
#   prove          the proof itself; returns only if it passed
# shellcheck disable=SC2154  # name and record are the sourcing file's
repository="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"

fail() {
  printf '%s: %s\n' "$name" "$*" >&2
  exit 1
}

# Taken from HEAD, as the proofs do: uncommitted changes are not what passed.
inputs_hash() {
  input_paths | xargs git -C "$repository" ls-tree -r HEAD -- | sha256sum | cut -d ' ' -f 1
}

recorded() {
  if [[ -f "$record" ]]; then
    sed -n "s/^$1 //p" "$record"
  fi
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
  if [[ "${1-}" == --if-changed && "$(recorded inputs)" == "$(inputs_hash)" ]]; then
    printf '%s: its inputs have not changed since commit %s, where it passed\n' "$name" "$(recorded commit)"
    return 0
  fi
  local commit inputs
  commit="$(git -C "$repository" rev-parse HEAD)"
  inputs="$(inputs_hash)"
  prove
  printf 'commit %s\ninputs %s\n' "$commit" "$inputs" >"$record"
  printf '%s: passed at %s; commit %s with it\n' "$name" "$commit" "${record#"$repository"/}"
}
