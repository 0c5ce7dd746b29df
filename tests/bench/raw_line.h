// A controller's line without a gateway: what a program does that has the line for itself, or believes so.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/link/descriptor.h"

namespace axisgate::bench {

// Not thread safe. Every function throws where the line fails.
class RawLine {
 public:
  static RawLine open_tty(const std::string& path);
  // "HOST:PORT", numeric, of a serial server's raw port. Waits half a second for a line, a tty waits for ever.
  static RawLine connect_tcp(const std::string& address);

  // Sends a line, and waits for the next line that comes, without its end. Nothing: none came.
  std::optional<std::string> ask(std::string_view line);
  // What was received and not yet asked about.
  void discard_received();

 private:
  explicit RawLine(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

  Descriptor descriptor_;
  std::string received_;
};

}  // namespace axisgate::bench
