# shellcheck shell=bash
# shellcheck disable=SC2154  # tests/clients.sh, which sources this, sets $built

# Reports names that could meet those of a program.
check_symbols() {
  local others
  others="$(nm -DC --defined-only build/clients/cpp/libaxisgate.so | cut -d' ' -f3- |
    grep -vE '^((typeinfo|typeinfo name|vtable) for )?axisgate::' || true)"
  [[ -z "$others" ]] || fail "libaxisgate.so exports $others"
}

# Installs the library into an empty folder, builds the examples with its CMake package, and one with pkg-config.
install_cpp() {
  local folder="$built/cpp" flags
  rm -rf "$folder" && mkdir -p "$folder" && cp -r clients/cpp/examples "$folder/user" &&
    cmake --install build --component cpp --prefix "$folder/prefix" >/dev/null &&
    cmake -S "$folder/user" -B "$folder/user/build" -DCMAKE_PREFIX_PATH="$folder/prefix" >/dev/null &&
    cmake --build "$folder/user/build" >/dev/null &&
    flags="$(PKG_CONFIG_PATH="$folder/prefix/lib/pkgconfig" pkg-config --cflags --libs axisgate)" &&
    read -ra flags <<<"$flags" &&
    g++ -std=c++20 -fsyntax-only "$folder/user/move.cc" "${flags[@]}"
}
run_cpp() {
  local example
  for example in move raster scan; do
    run_example "$built/cpp/user/build/$example" || return
  done
}

prove_cpp() {
  timed "c++: exported names" check_symbols
  timed "c++: installation" install_cpp
  timed "c++: examples" run_cpp
  timed "c++: scenario" conform_everywhere build/bin/axisgate-cpp-runner
}
