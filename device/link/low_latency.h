// Low latency of serial adapters.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace axisgate {

// A USB adapter collects what the controller sends before it passes it on, by default for up to 16 ms at some makes, so
// that each exchange takes as much longer. Asks its driver not to (ASYNC_LOW_LATENCY). If the adapter still does: a
// message for people that says how long, and what ends it. `path` is of the open `port`; `classes` is where the kernel
// shows its ttys.
std::optional<std::string> ask_for_low_latency(int port, const std::filesystem::path& path,
                                               const std::filesystem::path& classes = "/sys/class/tty");

}  // namespace axisgate
