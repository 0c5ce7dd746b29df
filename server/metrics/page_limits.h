// Limits for readers of the metrics page.
#pragma once

#include <chrono>
#include <cstddef>

#include "device/core/time.h"

namespace axisgate::server {

struct PageLimits {
  // Far more than a few Prometheus servers and people need. Each takes one of the descriptors that
  // connections/descriptor_limit.cc sets aside.
  std::size_t connections = 128;
  // Prometheus sends a few hundred bytes; 8 KiB is the limit of most servers. The request line may be counted apart.
  std::size_t head_bytes = 8192;
  // Time for a whole head. On loopback, only a busy machine needs more than a moment.
  Duration head = std::chrono::seconds(5);
  // Time for the reader to take an answer. Prometheus itself waits 10 s, unless it is configured otherwise.
  Duration answer = std::chrono::seconds(10);
  // Time between two requests. Longer than the usual minute of Prometheus, so that it keeps its connection.
  Duration idle = std::chrono::seconds(90);
  // Time for the reader to close after the last answer: closing first would discard the answer of a reader that still
  // sends.
  Duration leaving = std::chrono::seconds(1);
  // Bytes that are read meanwhile. A reader that sends without an end is never waited for, so no time ends it.
  std::size_t leaving_bytes = 1 << 20;
  // Maximum age of a text that is sent again: any number of readers costs at most ten texts a second.
  Duration text_age = std::chrono::milliseconds(100);
  // Delay before the next attempt when no descriptor was free to accept a connection.
  Duration accept_pause = std::chrono::milliseconds(50);
};

}  // namespace axisgate::server
