#!/usr/bin/env bash
# Proof that the two commands work on a Debian 12 with nothing installed: makes such a root with mmdebstrap, puts a
# clean clone of HEAD into it, and runs `deploy/quickstart.sh --once` and `tests/run.sh` there by chroot. Needs root;
# installs mmdebstrap where it is missing. The mirror is the one that this machine's apt uses.
# usage: tests/fresh-root.sh [--if-changed] [--empty-cache]
#   --if-changed    not if the same inputs have passed on this machine
#   --empty-cache   with a compiler cache of its own, as on a machine that has never built this
set -euo pipefail

name=fresh-root
# shellcheck source=tests/recorded-proof.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/recorded-proof.sh"
cache="${CCACHE_DIR:-$HOME/.cache/ccache}"
root=""
empty_cache=""

# What decides whether a bare Debian can build and run this; the code itself is what tests/run.sh is for.
input_paths() {
  git -C "$repository" ls-tree -r --name-only HEAD -- deploy/ CMakeLists.txt CMakePresets.json tests/run.sh \
    tests/fresh-root.sh tests/recorded-proof.sh |
    grep -E '(\.sh|\.txt|CMakePresets\.json)$'
}

make_root() {
  local sources
  sources="$(debian_sources)" || return
  mmdebstrap --quiet --variant=minbase bookworm "$root" - <<<"$sources" || return
  printf '127.0.0.1 localhost\n' >"$root/etc/hosts"  # as the installer of every Debian does
}

# At the same path as here, so that the compiler cache recognises what it compiled for this checkout.
clone_head() {
  mkdir -p "$root$repository"
  git clone --quiet --no-hardlinks "$repository" "$root$repository"
}

# Runs a command in the root. Mounts and processes live in namespaces of their own and vanish with the command, however
# it ends; so removing the root can never reach through a mount into this machine.
inside() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  unshare --mount --pid --fork --kill-child --propagation private bash -euc '
    root="$1" cache="$2" repository="$3"
    shift 3
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sysfs "$root/sys"
    mount --bind /dev "$root/dev"
    mount --bind /dev/pts "$root/dev/pts"
    mkdir -p "$root/ccache"
    mount --bind "$cache" "$root/ccache"
    env --ignore-environment HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 CCACHE_DIR=/ccache \
      CCACHE_BASEDIR="$repository" CCACHE_NOHASHDIR=1 \
      chroot "$root" "$@"
  ' fresh-root "$root" "$cache" "$repository" "$@"
}

prove() {
  ((EUID == 0)) || fail "needs root, for chroot and mount"
  timed "apt-get install mmdebstrap" install_tools mmdebstrap
  mkdir -p "$cache"
  root="$(mktemp --directory --tmpdir axisgate-fresh-root.XXXXXX)"
  chmod 755 "$root"
  trap 'rm -rf --one-file-system "$root"' EXIT
  timed "mmdebstrap" make_root
  if [[ -n "$empty_cache" ]]; then
    cache="$root/empty-cache"
    mkdir "$cache"
  fi
  timed "clone" clone_head
  timed "deploy/quickstart.sh --once" inside "$repository/deploy/quickstart.sh" --once
  # Whether all is there that the tests need; what 1,000 seeds find is for tests/run.sh itself.
  timed "tests/run.sh" inside env AXISGATE_SEEDS=100 "$repository/tests/run.sh"
}

arguments=()
for argument in "$@"; do
  if [[ "$argument" == --empty-cache ]]; then empty_cache=yes; else arguments+=("$argument"); fi
done
recorded_proof "${arguments[@]}"
