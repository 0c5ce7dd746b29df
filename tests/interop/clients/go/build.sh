#!/bin/bash
# build.sh FOLDER: generates the code of the API, and builds the client as FOLDER/client. go.mod pins all versions.
set -euo pipefail

[ $# = 1 ] || { echo "usage: build.sh FOLDER" >&2; exit 2; }
mkdir -p "$1"
folder=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
proto=$(cd "$here/../../../../proto" && pwd)
export CGO_ENABLED=0 GOTOOLCHAIN=local GOWORK=off

# The stamp lists all inputs. Nothing is done if the last build had the same ones.
stamp=$(cd "$here" && go version && protoc --version && sha256sum build.sh go.* ./*.go "$proto"/axisgate/v1/*.proto)
if [ -x "$folder/client" ] && [ "$stamp" = "$(cat "$folder/stamp" 2>/dev/null)" ]; then
    exit 0
fi

rm -rf "$folder/src" "$folder/stamp" "$folder/client"
mkdir "$folder/src"
cp "$here"/go.mod "$here"/go.sum "$here"/*.go "$folder/src"
cd "$folder/src"
GOBIN="$folder/bin" go install tool

# The M options put the generated code into this module instead of the package that the files name.
options=()
files=()
for path in "$proto"/axisgate/v1/*.proto; do
    file=${path#"$proto/"}
    files+=("$file")
    options+=("--go_opt=M$file=interop/api;api" "--go-grpc_opt=M$file=interop/api;api")
done
PATH="$folder/bin:$PATH" protoc -I "$proto" --go_out=. --go-grpc_out=. --go_opt=module=interop \
    --go-grpc_opt=module=interop "${options[@]}" "${files[@]}"

go build -buildvcs=false -trimpath -o "$folder/client" .
printf '%s\n' "$stamp" >"$folder/stamp"
