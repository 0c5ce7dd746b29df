// Runs another command and waits for its end.
#pragma once

#include <string>
#include <vector>

namespace axisgate::axisctl {

// Runs a command with NAME=VALUE in its environment. Returns its exit code, or, as a shell does, 128 + N if signal N
// ended it. While the command runs, axisctl ignores Ctrl-C, so that the command alone decides what to do. Throws
// Failure if the command cannot be started.
int run_child(const std::vector<std::string>& command, const std::string& name, const std::string& value);

}  // namespace axisgate::axisctl
