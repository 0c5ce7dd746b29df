// Controller's line without a gateway, as used by a program that has the line alone, or believes so.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/link/descriptor.h"

namespace axisgate::bench {

// A RawLine is a tty or a TCP connection to a controller. Not thread safe. All functions throw if the line fails.
class RawLine {
 public:
  static RawLine open_tty(const std::string& path);
  // Connects to the raw port of a serial server: "HOST:PORT", both numeric. ask() then waits half a second for a line;
  // with a tty it waits without limit.
  static RawLine connect_tcp(const std::string& address);

  // Sends a line and returns the next received line, without its terminator. nullopt if none arrived in time.
  std::optional<std::string> ask(std::string_view line);
  // Discards all bytes received up to now.
  void discard_received();

 private:
  explicit RawLine(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

  Descriptor descriptor_;
  std::string received_;
};

}  // namespace axisgate::bench
