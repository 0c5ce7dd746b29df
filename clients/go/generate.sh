#!/usr/bin/env bash
# Generates the Go code of the API (axisgate/v1), or with --check reports whether it is fresh. Needs Debian's
# protobuf-compiler and Go; the two plugins are built in a scratch folder, in the versions named here.
set -euo pipefail

PROTOC_GEN_GO=v1.36.10
PROTOC_GEN_GO_GRPC=v1.5.1

here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
protos="$here/../../proto"
module="$(sed -n 's/^go_module = //p' "$here/../names")"

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

# Installs a plugin outside this module, so that go.mod does not require it.
install() { (cd "$scratch" && GOBIN="$scratch" GOFLAGS=-mod=mod go install "$1"); }
install "google.golang.org/protobuf/cmd/protoc-gen-go@$PROTOC_GEN_GO"
install "google.golang.org/grpc/cmd/protoc-gen-go-grpc@$PROTOC_GEN_GO_GRPC"

mkdir "$scratch/out"
protoc --proto_path="$protos" --plugin="$scratch/protoc-gen-go" --plugin="$scratch/protoc-gen-go-grpc" \
  --go_out="$scratch/out" --go_opt=module="$module" --go-grpc_out="$scratch/out" --go-grpc_opt=module="$module" \
  "$protos"/axisgate/v1/*.proto

if [[ "${1:-}" == --check ]]; then
  diff --recursive --brief "$scratch/out/axisgate/v1" "$here/axisgate/v1" || {
    echo "generate.sh: axisgate/v1 is not fresh (to generate it again, run generate.sh)" >&2
    exit 1
  }
else
  rm -rf "$here/axisgate/v1"
  mkdir -p "$here/axisgate"
  cp -r "$scratch/out/axisgate/v1" "$here/axisgate/v1"
fi
