#!/usr/bin/env bash
# Builds the interop client on grpcio, for two versions of the library.
# usage: build.sh FOLDER     makes FOLDER/client (grpcio of requirements.txt) and FOLDER/client-debian (python3-grpcio)
set -euo pipefail

source="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
proto="$source/../../../../proto"

# Installs the pinned packages, unless the last run installed the same ones.
install_packages() {
  cmp --silent requirements.txt installed.txt && return
  rm -rf venv
  python3 -m venv venv
  venv/bin/pip install --quiet --disable-pip-version-check --only-binary :all: --requirement requirements.txt
  cp requirements.txt installed.txt
}

# Makes an executable $1 that runs client.py, beside itself, with the Python $2.
wrap() {
  cat > "$1" <<END
#!/bin/sh
folder="\$(dirname "\$(readlink -f "\$0")")"
exec $2 "\$folder/client.py" "\$@"
END
  chmod +x "$1"
}

main() {
  mkdir -p "$1"
  cd "$1"
  cp "$source"/{calls,client,rows}.py "$source/requirements.txt" .
  protoc --proto_path="$proto" --python_out=. --grpc_python_out=. \
    --plugin=protoc-gen-grpc_python="$(command -v grpc_python_plugin)" "$proto"/axisgate/v1/*.proto
  install_packages
  # shellcheck disable=SC2016  # The wrapper expands $folder.
  wrap client '"$folder/venv/bin/python"'
  wrap client-debian '/usr/bin/python3 -s'
}

if [ $# -ne 1 ]; then
  echo "usage: build.sh FOLDER" >&2
  exit 2
fi
main "$1"
