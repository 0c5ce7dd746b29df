// The host's end of the mill's line: a pseudo-terminal, or a TCP connection to a serial server.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/link/asio.h"
#include "device/link/descriptor.h"
#include "device/link/pty.h"

namespace axisgate::rml1::simulator {

// On the strand of the line.
class HostEnd {
 public:
  using Stream = boost::asio::posix::stream_descriptor;

  virtual ~HostEnd() = default;

  virtual std::size_t read(std::span<char> bytes) = 0;  // 0: none at present; does not wait
  virtual Stream& awaited() = 0;                        // becomes readable when read() may have more
  virtual void write(std::string_view bytes) = 0;       // XON and XOFF; what the host does not take is lost
  // Whether it sends no more after XOFF, and whether that has to be looked at again and again.
  virtual bool stops_at_xoff() const = 0;
  virtual bool may_change() const = 0;
  virtual std::string name() const = 0;  // "/tmp/mill (/dev/pts/7)", "127.0.0.1:4001"
  virtual void close() = 0;
};

// What one client has written and the mill has not read is still read when the client has left, and the settings of the
// terminal stay, as with a serial port. A host stops at XOFF where its terminal has IXON.
Result<std::unique_ptr<HostEnd>> open_pty_end(const Strand& strand, const std::string& link);

// Listens on loopback; 0 is any free port. One client at a time, the next when it has left. The serial server obeys
// XOFF by itself.
Result<std::unique_ptr<HostEnd>> open_tcp_end(const Strand& strand, int port);

}  // namespace axisgate::rml1::simulator
