// The measurements of axisgate-bench, one or more subcommands a file.
#pragma once

#include <CLI/CLI.hpp>

namespace axisgate::bench {

void add_asks(CLI::App& program);
void add_moves(CLI::App& program);
void add_stop_under_load(CLI::App& program);
void add_streams(CLI::App& program);
void add_wrong_replies(CLI::App& program);

}  // namespace axisgate::bench
