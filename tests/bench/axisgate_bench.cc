// axisgate-bench: runs one end-to-end measurement for bench.py, which starts the measured programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "tests/bench/subcommands.h"

int main(int count, char** words) {
  CLI::App program("Makes one measurement, and prints its figures as a line of JSON.", "axisgate-bench");
  program.require_subcommand(1);
  axisgate::bench::add_asks(program);
  axisgate::bench::add_moves(program);
  axisgate::bench::add_stop_under_load(program);
  axisgate::bench::add_streams(program);
  axisgate::bench::add_wrong_replies(program);
  try {
    CLI11_PARSE(program, count, words);
  } catch (const std::exception& error) {
    fmt::print(stderr, "axisgate-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
