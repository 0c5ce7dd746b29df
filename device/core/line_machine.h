// Interfaces between a sans-I/O state machine and the shell that drives it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/time.h"

namespace axisgate {

// Requests of a machine to its line. Implemented by device/link in production and by the seeded simulation.
class ByteLink {
 public:
  virtual ~ByteLink() = default;

  // Queues bytes for the line, in order. Never blocks, never calls back into the machine.
  virtual void write(std::string_view bytes) = 0;

  // Discards the bytes queued in both directions, closes the line, and opens it again after `wait`. The machine
  // receives link_up or link_down.
  virtual void reopen(Duration wait) = 0;
};

// A line whose flow control matters: its device takes bytes only when it has room, and never answers.
class FlowLink : public ByteLink {
 public:
  // Number of written bytes that have not left this host, as far as its driver knows.
  virtual std::size_t unsent() const = 0;
  // Reports whether flow control forbids sending now, as far as the host sees it (CTS, DSR): the device's buffer is
  // full, or the device is off.
  virtual bool held() const = 0;
  // True: sends even if flow control forbids it. False: obeys flow control again.
  virtual void ignore_flow_control(bool ignored) = 0;
};

// A state machine at the end of a line: its input is bytes and time, its output is bytes and the next deadline.
// Not thread safe: its shell calls every member from one strand, with time that never decreases.
class LineMachine {
 public:
  virtual ~LineMachine() = default;

  virtual void link_up(TimePoint now) = 0;
  virtual void link_down(TimePoint now, std::string_view why) = 0;
  virtual void receive(std::string_view bytes, TimePoint now) = 0;
  virtual void advance(TimePoint now) = 0;

  // Time at which advance() must be called next; nullopt if only bytes can change the machine.
  virtual std::optional<TimePoint> next_deadline() const = 0;
};

}  // namespace axisgate
