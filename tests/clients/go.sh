# shellcheck shell=bash
# shellcheck disable=SC2154  # tests/clients.sh, which sources this, sets $built

check_go() {
  clients/go/generate.sh --check &&
    (cd clients/go && test -z "$(gofmt -l .)" && go vet ./... && go build -o "$built/go/runner" ./internal/conformance)
}
test_go() {
  (cd clients/go && go test -count=1 ./...)  # the daemon is no input that Go sees
}

# Makes a module proxy in a folder, and builds an example in an empty module that gets the package from there.
install_go() {
  local folder="$built/go" version
  version="v0.1.0-h$(git rev-parse HEAD)"  # Go never downloads a version twice
  rm -rf "$folder/proxy" "$folder/user" && mkdir -p "$folder/user" &&
    tests/clients/go_proxy.py clients/go "$folder/proxy" "$version" &&
    cp clients/go/examples/move/main.go "$folder/user" &&
    (cd "$folder/user" && export GOPROXY="file://$folder/proxy,$(go env GOPROXY)" GONOSUMDB='axisgate.example/*' &&
      go mod init user 2>/dev/null && go get "axisgate.example/go@$version" 2>/dev/null && go mod tidy 2>/dev/null &&
      go build -o move .) &&
    run_example "$folder/user/move"
}

prove_go() {
  timed "go: generated code, gofmt, vet" check_go
  timed "go: tests" test_go
  timed "go: scenario" conform_everywhere "$built/go/runner"
  timed "go: module from a proxy, example" install_go
}
