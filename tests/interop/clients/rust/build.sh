#!/bin/bash
# build.sh FOLDER: builds the client in FOLDER and leaves the executable FOLDER/client there.
set -euo pipefail

if [ $# -ne 1 ]; then
    echo "usage: build.sh FOLDER" >&2
    exit 2
fi
source=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
proto=$(cd "$source/../../../../proto" && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)

# `install -C` leaves a copy alone if it is the same as the file, so that cargo has nothing to do.
install -C -m 644 -D -t "$folder/source" "$source/Cargo.toml" "$source/build.rs"
install -C -m 644 -D -t "$folder/source/src" "$source"/src/*.rs
install -C -m 644 -D -t "$folder/source/proto/axisgate/v1" "$proto"/axisgate/v1/*.proto

cd "$folder/source"
CARGO_TARGET_DIR="$folder/target" cargo build --quiet --jobs 1
install -C -m 755 "$folder/target/debug/client" "$folder/client"
