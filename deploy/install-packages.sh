#!/usr/bin/env bash
# Installs what is missing of deploy/debian-packages.txt. Asks nothing, and needs no network when nothing is missing.
# usage: deploy/install-packages.sh [--to-build]     with --to-build without what only the tests need
set -euo pipefail

list="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/debian-packages.txt"

to_build=false

read_arguments() {
  case "${1-}" in
    "") ;;
    --to-build) to_build=true ;;
    *)
      printf 'install-packages: unknown argument "%s"; usage: deploy/install-packages.sh [--to-build]\n' "$1" >&2
      return 1
      ;;
  esac
}

# Prints the list, or the part before the packages that only the tests need.
chosen_part() {
  if $to_build; then sed '/^# --- to test/,$d' "$list"; else cat "$list"; fi
}

listed_packages() {
  chosen_part | sed 's/#.*//' | tr -s ' \t' '\n' | sed '/^$/d'
}

# Multi-arch packages are answered as name:architecture when asked by pattern; the plain name is what is compared.
# dpkg-query fails for a package that dpkg has never heard of, which is an answer here and no error.
missing_packages() {
  local installed
  # shellcheck disable=SC2016  # the dollar signs are dpkg-query's
  installed="$({ listed_packages | xargs dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' || true; } \
    2>/dev/null | sed -n 's/^installed //p' | sort -u)"
  comm -23 <(listed_packages | sort -u) <(printf '%s\n' "$installed")
}

# Runs a quiet command; what it said is shown only when it failed.
quietly() {
  local output
  if ! output="$("$@" 2>&1)"; then
    printf '%s\n' "$output" >&2
    printf 'install-packages: failed: %s\n' "$*" >&2
    return 1
  fi
}

# Debian would start the server of package prometheus at once and at every boot, open to every network. The tests start
# one of their own; `systemctl unmask prometheus` gives the service back.
mask_service() {
  local unit="/etc/systemd/system/$1.service"
  if [[ ! -e "$unit" && ! -L "$unit" ]]; then
    "${as_root[@]}" mkdir -p "${unit%/*}"
    "${as_root[@]}" ln -s /dev/null "$unit"
  fi
}

main() {
  read_arguments "$@"
  if ! command -v dpkg-query >/dev/null; then
    echo "install-packages: this is no Debian system; install by hand what $list lists" >&2
    return 1
  fi
  local -a missing as_root=()
  mapfile -t missing < <(missing_packages)
  if ((${#missing[@]} == 0)); then
    return 0
  fi
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      printf 'install-packages: packages are missing and this user may not install them. As root, run:\n' >&2
      printf '  apt-get update && apt-get install --no-install-recommends --yes %s\n' "${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  printf 'Installing %d packages: %s\n' "${#missing[@]}" "${missing[*]}"
  if [[ " ${missing[*]} " == *" prometheus "* ]]; then
    mask_service prometheus
  fi
  quietly "${as_root[@]}" apt-get update --quiet
  quietly "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends \
    "${missing[@]}"
}

main "$@"
