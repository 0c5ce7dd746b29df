#!/usr/bin/env bash
# Generates the Python code of the API (src/axisgate/v1) and of _status.proto. Needs Debian's protobuf-compiler and
# protobuf-compiler-grpc: code of their versions runs with every later version of protobuf and grpcio.
set -euo pipefail

here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
protos="$here/../../proto"
src="$here/src"

plugin="$(command -v grpc_python_plugin)" || {
  echo "generate.sh: grpc_python_plugin is missing: apt-get install protobuf-compiler-grpc" >&2
  exit 1
}

protoc --proto_path="$protos" --python_out="$src" --pyi_out="$src" \
  --plugin=protoc-gen-grpc="$plugin" --grpc_out="$src" "$protos"/axisgate/v1/*.proto
protoc --proto_path="$src" --python_out="$src" --pyi_out="$src" "$src/axisgate/_status.proto"
