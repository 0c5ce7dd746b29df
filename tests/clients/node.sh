# shellcheck shell=bash
# shellcheck disable=SC2154  # tests/clients.sh, which sources this, sets $built

check_node() {
  (cd clients/node && npm ci --no-audit --no-fund --loglevel=error >/dev/null && npm run --silent build &&
    npm run --silent lint)
}
test_node() {
  (cd clients/node && npm test --silent)
}

# Packs the package, and installs it into an empty folder, where the compiler makes the example a program.
install_node() {
  local folder="$built/node" archive
  rm -rf "$folder" && mkdir -p "$folder" &&
    archive="$(cd clients/node && npm pack --silent --ignore-scripts --pack-destination "$folder")" &&
    cp clients/node/examples/move.ts "$folder/move.mts" &&
    (cd "$folder" && npm init --yes >/dev/null &&
      npm install --no-audit --no-fund --loglevel=error "./$archive" >/dev/null) &&
    clients/node/node_modules/.bin/tsc --module nodenext --target es2022 --lib es2022,esnext.disposable \
      --skipLibCheck --types node --typeRoots clients/node/node_modules/@types "$folder/move.mts" &&
    run_example node "$folder/move.mjs"
}

prove_node() {
  timed "node: build, prettier, eslint" check_node
  timed "node: tests" test_node
  timed "node: scenario" conform_everywhere clients/node/conformance/runner.mjs
  timed "node: npm pack, example" install_node
}
