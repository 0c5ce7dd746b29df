#!/usr/bin/env bash
# Generates the TypeScript code of the API and of status.proto (src/gen). Needs Debian's protobuf-compiler.
set -euo pipefail

here="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
protos="$here/../../proto"
to="$here/src/gen"

rm -rf "$to"
mkdir -p "$to"
protoc --proto_path="$protos" --proto_path="$here/src" \
  --plugin=protoc-gen-es="$here/node_modules/.bin/protoc-gen-es" \
  --es_out="$to" --es_opt=target=ts,import_extension=js \
  "$protos"/axisgate/v1/*.proto "$here/src/status.proto"
