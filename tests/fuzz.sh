#!/usr/bin/env bash
# Fuzzes the RML-1 parser, parser with machine and pictures, and the front's HTTP/2, with libFuzzer.
# usage: tests/fuzz.sh [SECONDS]     so long for each of these, from what was found before on; 1800 make an hour. Without
#                                    it the same 10,000 inputs each time. What fails stays in build-fuzz/, is tried first from
#                                    then on, and is told with the line that shows it again.
set -euo pipefail

root="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
seconds="${1-}"
build="$root/build-fuzz"
launcher="$(command -v ccache || true)"
# libstdc++ 12 uses what it calls deprecated itself.
flags=(-std=c++20 -Wno-deprecated-declarations -g -O1 -I"$root" "-fsanitize=address,undefined"
  -fno-sanitize-recover=undefined)
# With other addresses libFuzzer tries other jobs.
fixed=()
if setarch -R true 2> /dev/null; then fixed=(setarch -R); fi

object_of() {
  printf '%s/%s.o' "$build" "${1//\//_}"
}

compile() {
  $launcher clang++-19 "${flags[@]}" -fsanitize=fuzzer-no-link -c "$1" -o "$(object_of "$1")"
}

run() {
  local target="$1" failed
  shift
  "${fixed[@]}" "$build/$target" -max_len=4096 -timeout=10 -artifact_prefix="$build/$target-" "$@" \
    >> "$build/$target.log" 2>&1 || {
    tail -n 60 "$build/$target.log"
    failed="$(sed -n 's/.*Test unit written to //p' "$build/$target.log" | tail -n 1)"
    # Nothing is written when what failed before fails again: then the same arguments show it.
    printf 'tests/fuzz.sh: see it again: %s\n' "$build/$target ${failed:-$*}"
    exit 1
  }
}

fuzz() {
  local target="$1" corpus="$build/corpus-$1" examples="tests/fuzz/corpus" failed
  if [[ "$target" == front_fuzz ]]; then examples=""; fi  # those are mill jobs
  rm -f "$build/$target.log"
  for failed in "$build/$target"-{crash,leak,oom,timeout}-*; do
    if [[ -e "$failed" ]]; then run "$target" "$failed"; fi
  done
  if [[ -n "$seconds" ]]; then
    mkdir -p "$corpus"
    run "$target" -max_total_time="$seconds" -print_final_stats=1 "$corpus" $examples
  else
    rm -rf "$build/scratch"
    mkdir "$build/scratch"  # libFuzzer writes into the first folder
    # Nor may it look, each second, at what it wrote.
    run "$target" -runs=10000 -seed=1 -reload=0 -print_final_stats=1 "$build/scratch" $examples
  fi
  printf '%s: %s executions, %s\n' "$target" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$target.log" | tail -n 1)" \
    "$(grep -o 'cov: [0-9]* ft: [0-9]*' "$build/$target.log" | tail -n 1)"
}

cd "$root"
mkdir -p "$build"
jobs=(device/jobs/{bounds,extent,place}.cc device/rml1/{language,machine,check,picture}/*.cc device/config/*.cc
  tests/rml1/mill.cc tests/fuzz/grammar.cc)
front=(server/front/{conversation,grpc_side,own_calls,http2_session,request_body,headers,spending,replies,budget}.cc
  tests/http2/{frames,header_codec}.cc)

# TARGET SOURCE...
build_and_fuzz() {
  local target="$1" objects=() source
  shift
  for source in "$@" "tests/fuzz/$target.cc"; do
    compile "$source"
    objects+=("$(object_of "$source")")
  done
  clang++-19 "${flags[@]}" -fsanitize=fuzzer "${objects[@]}" -lfmt -lnghttp2 -lpng -lz -lcrypto -o "$build/$target"
  fuzz "$target"
}

build_and_fuzz parser_fuzz "${jobs[@]}"
build_and_fuzz machine_fuzz "${jobs[@]}"
build_and_fuzz front_fuzz "${front[@]}"
