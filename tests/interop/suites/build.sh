#!/usr/bin/env bash
# Builds h2spec, grpcurl and ghz from their published sources. h2spec asks by GET and without a content type, which is no
# call of gRPC, so that is changed, and it gets a token; the versions of what it is built with are in go.mod beside this.
# usage: build.sh FOLDER
set -euo pipefail

here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
folder="$1"
export GOFLAGS="-p=1" GOBIN="$folder" CGO_ENABLED=0 GOTOOLCHAIN=local

build_h2spec() {
  local source
  source="$(go mod download -json github.com/summerwind/h2spec@v2.2.1+incompatible | sed -n 's/^\t"Dir": "\(.*\)",$/\1/p')"
  rm -rf "$folder/h2spec-source"
  cp -r "$source" "$folder/h2spec-source"
  chmod -R u+w "$folder/h2spec-source"
  cp "$here/go.mod" "$here/go.sum" "$folder/h2spec-source"
  sed -i -e 's|HeaderField(":method", "GET"),|HeaderField(":method", "POST"),|' \
    -e 's|HeaderField(":authority", authority),|&\n\t\tHeaderField("content-type", "application/grpc"),|' \
    -e 's|HeaderField("content-type", "application/grpc"),|&\n\t\tHeaderField("te", "trailers"),|' \
    -e 's|HeaderField("te", "trailers"),|&\n\t\tHeaderField("authorization", "Bearer "+os.Getenv("H2SPEC_TOKEN")),|' \
    -e 's|^import (|&\n\t"os"|' \
    "$folder/h2spec-source/spec/util.go"
  (cd "$folder/h2spec-source" && go build -o "$folder/h2spec" ./cmd/h2spec)
}

mkdir -p "$folder"
if [[ ! -x "$folder/h2spec" ]]; then build_h2spec; fi
if [[ ! -x "$folder/grpcurl" ]]; then go install github.com/fullstorydev/grpcurl/cmd/grpcurl@v1.9.3; fi
if [[ ! -x "$folder/ghz" ]]; then go install github.com/bojand/ghz/cmd/ghz@v0.93.0; fi
