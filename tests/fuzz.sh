#!/usr/bin/env bash
# Fuzzes the RML-1 parser, and parser with machine, with libFuzzer.
# usage: tests/fuzz.sh [SECONDS]     for each of the two; without it 1800, which makes an hour on one core. What is found
#                                    stays in build-fuzz/, with the line that shows it again.
set -euo pipefail

root="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
seconds="${1:-1800}"
build="$root/build-fuzz"
launcher="$(command -v ccache || true)"
# libstdc++ 12 uses what it calls deprecated itself.
flags=(-std=c++20 -Wno-deprecated-declarations -g -O1 -I"$root" -fsanitize=address,undefined -fno-sanitize-recover=undefined)
coverage=(-fsanitize=fuzzer-no-link)

compile() {
  local object="$build/${1//\//_}.o"
  $launcher clang++-19 "${flags[@]}" "${coverage[@]}" -c "$root/$1" -o "$object"
  objects+=("$object")
}

fuzz() {
  local target="$1" corpus="$build/corpus-$1"
  clang++-19 "${flags[@]}" -fsanitize=fuzzer "$build/tests_fuzz_$target.cc.o" "${objects[@]}" -lfmt -o "$build/$target"
  mkdir -p "$corpus"
  "$build/$target" -max_total_time="$seconds" -max_len=4096 -timeout=10 -print_final_stats=1 -verbosity=1 \
    -artifact_prefix="$build/$target-" "$corpus" "$root/tests/fuzz/corpus" > "$build/$target.log" 2>&1 ||
    { tail -n 60 "$build/$target.log"; exit 1; }
  printf '%s: %s, %s\n' "$target" \
    "$(sed -n 's/^stat::number_of_executed_units: */executions /p' "$build/$target.log")" \
    "$(grep -o 'cov: [0-9]* ft: [0-9]*' "$build/$target.log" | tail -n 1)"
}

mkdir -p "$build"
cd "$root"
objects=()
for source in device/rml1/{axes_reader,check,clip,diagnostic,instruction_table,judge,machine,number_reader,parser,planner,profile}.cc \
  device/core/{config_error,config_file}.cc tests/rml1/mill.cc tests/fuzz/grammar.cc; do
  compile "$source"
done
shared=("${objects[@]}")
for target in parser_fuzz machine_fuzz; do
  compile "tests/fuzz/$target.cc"
  objects=("${shared[@]}")
done
for target in parser_fuzz machine_fuzz; do
  fuzz "$target"
done
