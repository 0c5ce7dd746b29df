#!/usr/bin/env bash
# Proof that the Dockerfile builds, and that what it builds runs: buildah builds HEAD on a Debian 12 made by mmdebstrap,
# podman runs it as somebody would who trusts nothing (no capabilities, nothing writable), and axisctl homes and moves
# its simulated stage. Needs root; installs buildah, podman, runc and mmdebstrap where they are missing. Images and
# containers live in a folder of their own that is removed at the end.
# usage: tests/image.sh [--if-changed]    with --if-changed not if the same inputs have passed on this machine
set -euo pipefail

name=image
# shellcheck source=tests/recorded-proof.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/recorded-proof.sh"
cache="${CCACHE_DIR:-$HOME/.cache/ccache}"
tools=(buildah podman runc mmdebstrap)
ready_limit_s=30
end_limit_s=10
call_limit_s=60
scratch=""
container=""

# The programs themselves are what tests/run.sh is for; here it is what they are built with, linked with and called by.
input_paths() {
  git -C "$repository" ls-tree -r --name-only HEAD -- Dockerfile .dockerignore deploy/debian-packages.txt \
    deploy/install-packages.sh deploy/mills CMakeLists.txt CMakePresets.json tests/image.sh tests/recorded-proof.sh |
    sort
  git -C "$repository" ls-tree -r --name-only HEAD -- clients device proto server | grep 'CMakeLists\.txt$'
}

# Both keep what they make in the same place. vfs works on any file system, and inside another container, too.
in_buildah() {
  buildah --root "$scratch/storage" --runroot "$scratch/run" --storage-driver vfs "$@"
}

in_podman() {
  timeout "$call_limit_s" podman --root "$scratch/storage" --runroot "$scratch/run" --storage-driver vfs \
    --cgroup-manager cgroupfs --runtime "$(command -v runc)" "$@"
}

in_container() {
  in_podman exec "$container" "$@"
}

# Under the name that the Dockerfile asks for; localhost is where buildah looks first.
make_base() {
  local sources base
  sources="$(debian_sources)" &&
    mmdebstrap --quiet --variant=minbase bookworm "$scratch/base.tar" - <<<"$sources" &&
    base="$(in_buildah from scratch)" &&
    in_buildah add --quiet "$base" "$scratch/base.tar" / >/dev/null &&
    in_buildah commit --quiet --rm "$base" localhost/debian:bookworm-slim >/dev/null &&
    rm "$scratch/base.tar"
}

# --format docker: the other one has no place for a health check.
build_image() {
  mkdir "$scratch/context" && git -C "$repository" archive HEAD | tar --extract --directory "$scratch/context" &&
    in_buildah bud --quiet --isolation chroot --pull-never --format docker --tag axisgate \
      --volume "$cache:/ccache" --build-arg CCACHE_DIR=/ccache \
      --build-arg REVISION="$(git -C "$repository" rev-parse HEAD)" "$scratch/context" >/dev/null
}

start_container() {
  printf 'listen = "127.0.0.1:0"\nmetrics = "127.0.0.1:0"\n[[device]]\nname = "stage"\nconnection = "simulated"\n' \
    >"$scratch/axisgate.toml"
  chmod 644 "$scratch/axisgate.toml"
  # The limits are set since podman's own are higher than an unprivileged outer container permits.
  container="$(in_podman run --detach --log-driver k8s-file --network host --read-only --cap-drop all \
    --security-opt no-new-privileges --no-healthcheck --ulimit nofile=1024:1024 --ulimit nproc=1024:1024 \
    --volume "$scratch/axisgate.toml:/etc/axisgate/axisgate.toml:ro" \
    localhost/axisgate --config /etc/axisgate/axisgate.toml)"
}

health_check() {
  local -a command
  mapfile -t command < <(in_podman image inspect --format \
    '{{range .HealthCheck.Test}}{{println .}}{{end}}' localhost/axisgate | sed '1d;/^$/d')
  ((${#command[@]} > 0)) && in_container "${command[@]}"
}

wait_until_up() {
  local deadline=$((SECONDS + ready_limit_s))
  until health_check 2>&1 | grep ' UP$'; do
    if ((SECONDS >= deadline)); then
      in_podman logs "$container" >&2
      return 1
    fi
    sleep 0.2
  done
}

call() {
  in_container axisctl status && in_container axisctl home && in_container axisctl move 1=+1mm --relative
}

check_job() {
  in_container sh -c "printf 'PA;PU100,100;PD200,100;PU;' | axisctl mill check - --profile mdx-20" &&
    in_container sh -c "printf 'PA;PU100,100;PD200,100;PU;' |
      axisctl mill preview - --profile srm-20 --output /run/axisgate/job.svg && test -s /run/axisgate/job.svg"
}

check_user() {
  [[ "$(in_container id --user)" == 203 ]] && [[ "$(in_container id --groups --name)" == "axisgate dialout" ]] &&
    [[ "$(in_container stat --format %u /proc/1)" == 203 ]]
}

# What builds software has no place beside what runs it.
check_contents() {
  local packages found
  # shellcheck disable=SC2016  # expanded by dpkg-query
  packages="$(in_container dpkg-query --show --showformat='${Package}\n')" || return
  found="$(grep -E -- '-dev$|^(g\+\+|gcc|cpp|clang|binutils|make|cmake|ninja-build|ccache|git|python3)(-[0-9]+)?$' \
    <<<"$packages" || true)"
  if [[ -n "$found" ]]; then
    printf 'the image has %s\n' "$found" >&2
    return 1
  fi
  # shellcheck disable=SC2016  # expanded inside
  in_container sh -c 'for tool in cc c++ gcc g++ clang ld as make cmake protoc; do ! command -v "$tool" || exit 1; done'
}

end_container() {
  local code
  in_podman kill --signal TERM "$container" >/dev/null || return
  code="$(call_limit_s=$end_limit_s in_podman wait "$container")" || true
  if [[ "$code" != 0 ]]; then
    printf 'exit code within %d s of SIGTERM: %s\n' "$end_limit_s" "${code:-none}" >&2
    return 1
  fi
}

clean_up() {
  if [[ -n "$container" ]]; then
    in_podman rm --force --time 0 "$container" >/dev/null 2>&1 || true
  fi
  rm -rf --one-file-system "$scratch"
}

prove() {
  ((EUID == 0)) || fail "needs root, for chroot and mount"
  timed "apt-get install ${tools[*]}" install_tools "${tools[@]}"
  mkdir -p "$cache"
  scratch="$(mktemp --directory --tmpdir axisgate-image.XXXXXX)"
  chmod 755 "$scratch"
  trap clean_up EXIT
  timed "a Debian 12 to build on" make_base
  timed "buildah bud" build_image
  timed "podman run" start_container
  timed "the health check" wait_until_up
  timed "axisctl status, home, move" call
  timed "axisctl mill check, mill preview" check_job
  timed "runs as its own user" check_user
  timed "no compiler, no -dev package" check_contents
  timed "the end by SIGTERM" end_container
}

recorded_proof "$@"
