// What the metrics page allows its readers, and how long it waits for them.
#pragma once

#include <chrono>
#include <cstddef>

#include "device/core/time.h"

namespace axisgate::server {

struct PageLimits {
  // Far more than a few Prometheus servers and people need. Each takes a descriptor of those that
  // connections/descriptor_limit.cc sets aside.
  std::size_t connections = 128;
  // Prometheus sends a few hundred bytes; 8 KiB is what most servers allow.
  std::size_t head_bytes = 8192;
  // For a whole head. On loopback it is there at once, unless its sender is not served by a busy machine.
  Duration head = std::chrono::seconds(5);
  // For an answer to be taken. Prometheus itself waits 10 s for it, unless it is configured otherwise.
  Duration answer = std::chrono::seconds(10);
  // Between two requests. Longer than the minute that Prometheus usually leaves, so that it keeps its connection.
  Duration idle = std::chrono::seconds(90);
  // For the reader to close after the last answer: closing first would discard an answer whose reader still sends.
  Duration leaving = std::chrono::seconds(1);
  // How old a text may be that is sent again: so many readers cost no more than ten texts a second.
  Duration text_age = std::chrono::milliseconds(100);
  // Until the next attempt when a connection could not be accepted, for lack of descriptors.
  Duration accept_pause = std::chrono::milliseconds(50);
};

}  // namespace axisgate::server
