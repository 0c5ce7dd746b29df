// Low latency of serial adapters.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace axisgate {

// Asks the driver of a serial adapter to pass on bytes at once (ASYNC_LOW_LATENCY). A USB adapter collects the
// controller's bytes before it passes them on, for up to 16 ms by default with some makes, and each exchange takes that
// much longer. If the adapter still delays bytes, returns a message for people with the delay and the remedy; otherwise
// nullopt. `path`: path of the open `port`. `classes`: directory in which the kernel shows its ttys.
std::optional<std::string> ask_for_low_latency(int port, const std::filesystem::path& path,
                                               const std::filesystem::path& classes = "/sys/class/tty");

}  // namespace axisgate
