// Subcommands of axisgate-bench, its measurements. Each file defines one or more.
#pragma once

#include <CLI/CLI.hpp>

namespace axisgate::bench {

void add_asks(CLI::App& program);
void add_moves(CLI::App& program);
void add_stop_under_load(CLI::App& program);
void add_streams(CLI::App& program);
void add_wrong_replies(CLI::App& program);

}  // namespace axisgate::bench
