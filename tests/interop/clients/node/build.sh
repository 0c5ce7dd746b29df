#!/usr/bin/env bash
# Builds the interop client on @grpc/grpc-js.
# usage: build.sh FOLDER     makes FOLDER/client
set -euo pipefail

source="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
proto="$source/../../../../proto"

# Installs the pinned packages, unless the last run installed the same ones.
install_packages() {
  cmp --silent package-lock.json installed-lock.json && return
  npm ci --ignore-scripts --no-audit --no-fund
  cp package-lock.json installed-lock.json
}

main() {
  mkdir -p "$1"
  cd "$1"
  cp "$source"/{api,client,rows}.js "$source"/package{,-lock}.json .
  rm -rf proto
  cp -R "$proto" proto
  install_packages
  # The wrapper finds its sources beside itself.
  cat > client <<'END'
#!/bin/sh
exec node "$(dirname "$(readlink -f "$0")")/client.js" "$@"
END
  chmod +x client
}

if [ $# -ne 1 ]; then
  echo "usage: build.sh FOLDER" >&2
  exit 2
fi
main "$1"
