// A command that this one runs and waits for.
#pragma once

#include <string>
#include <vector>

namespace axisgate::axisctl {

// Runs it with NAME=VALUE in its environment and answers with its exit code, 128 + N where signal N ended it, as a
// shell does. While it runs Ctrl-C is its own affair. Throws Failure where it cannot be started.
int run_child(const std::vector<std::string>& command, const std::string& name, const std::string& value);

}  // namespace axisgate::axisctl
