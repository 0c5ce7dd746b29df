# shellcheck shell=bash
# shellcheck disable=SC2154  # tests/clients.sh, which sources this, sets $built

export CARGO_TARGET_DIR="${CARGO_TARGET_DIR-$HOME/.cache/axisgate/rust}"

check_rust() {
  (cd clients/rust && cargo fmt --check && cargo fmt --check --manifest-path conformance/Cargo.toml &&
    cargo clippy --quiet --all-targets --all-features -- -D warnings &&
    cargo clippy --quiet --manifest-path conformance/Cargo.toml -- -D warnings &&
    RUSTDOCFLAGS="-D warnings" cargo doc --quiet --no-deps --all-features)
}
test_rust() {
  (cd clients/rust && cargo test --quiet --all-features -- --test-threads 2)
}
build_rust_runner() {
  cargo build --quiet --manifest-path clients/rust/conformance/Cargo.toml
}

# Packs the crate, and builds an example in an empty program that uses what was packed.
install_rust() {
  local folder="$built/rust"
  rm -rf "$folder" && mkdir -p "$folder/user/src" && (cd clients/rust && cargo package --quiet --allow-dirty) &&
    tar --extract --gzip --file "$CARGO_TARGET_DIR/package/axisgate-0.1.0.crate" --directory "$folder" &&
    cp "$folder/axisgate-0.1.0/examples/move.rs" "$folder/user/src/main.rs" &&
    printf '%s\n' '[package]' 'name = "axisgate-user"' 'version = "0.0.0"' 'edition = "2021"' '[dependencies]' \
      'axisgate = { path = "../axisgate-0.1.0" }' \
      'tokio = { version = "1.40", features = ["macros", "rt-multi-thread", "signal"] }' '[workspace]' \
      >"$folder/user/Cargo.toml" &&
    cargo build --quiet --manifest-path "$folder/user/Cargo.toml" && run_example "$CARGO_TARGET_DIR/debug/axisgate-user"
}

prove_rust() {
  timed "rust: format, clippy, reference" check_rust
  timed "rust: tests" test_rust
  timed "rust: runner" build_rust_runner
  timed "rust: scenario" conform_everywhere "$CARGO_TARGET_DIR/debug/axisgate-conformance"
  timed "rust: cargo package, example" install_rust
}
