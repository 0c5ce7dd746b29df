// The two seams between a sans-I/O state machine and the shell that drives it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/time.h"

namespace axisgate {

// What a machine may ask of its line. Implemented by device/link in production and by the seeded simulation.
class ByteLink {
 public:
  virtual ~ByteLink() = default;

  // Queues bytes for the line, in order. Never blocks, never calls back into the machine.
  virtual void write(std::string_view bytes) = 0;

  // Discards what is queued both ways, closes, and opens again after `wait`. The machine receives link_up or link_down.
  virtual void reopen(Duration wait) = 0;
};

// A line whose flow control matters: to a device that takes bytes when it has room, and never answers.
class FlowLink : public ByteLink {
 public:
  // Of what was written, how many bytes have not left this host, as far as its driver knows.
  virtual std::size_t unsent() const = 0;
  // Flow control forbids sending now, as far as the host sees it (CTS, DSR): the device's buffer is full, or it is off.
  virtual bool held() const = 0;
  // Sends whether flow control forbids it or not, until it is respected again.
  virtual void ignore_flow_control(bool ignored) = 0;
};

// A state machine at the end of a line: bytes and time go in, bytes and the next deadline come out.
// Not thread safe: its shell calls every member from one strand, with time that never runs backwards.
class LineMachine {
 public:
  virtual ~LineMachine() = default;

  virtual void link_up(TimePoint now) = 0;
  virtual void link_down(TimePoint now, std::string_view why) = 0;
  virtual void receive(std::string_view bytes, TimePoint now) = 0;
  virtual void advance(TimePoint now) = 0;

  // When advance() wants to be called next; nothing when only bytes can change anything.
  virtual std::optional<TimePoint> next_deadline() const = 0;
};

}  // namespace axisgate
