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

// Runs on the strand of the line.
class HostEnd {
 public:
  using Stream = boost::asio::posix::stream_descriptor;

  virtual ~HostEnd() = default;

  virtual std::size_t read(std::span<char> bytes) = 0;  // returns 0 if there are no bytes at present; does not wait
  virtual Stream& awaited() = 0;                        // becomes readable when read() may have more
  virtual void write(std::string_view bytes) = 0;       // XON and XOFF; bytes that the host does not take are lost
  // Report whether the host stops sending after XOFF, and whether this may change, so that it must be polled.
  virtual bool stops_at_xoff() const = 0;
  virtual bool may_change() const = 0;
  virtual std::string name() const = 0;  // "/tmp/mill (/dev/pts/7)", "127.0.0.1:4001"
  virtual void close() = 0;
};

// Opens a pseudo-terminal. Bytes of a client that the mill has not read are still read after the client has left, and
// the settings of the terminal stay, as with a serial port. A host stops at XOFF if its terminal has IXON.
Result<std::unique_ptr<HostEnd>> open_pty_end(const Strand& strand, const std::string& link);

// Listens on loopback; port 0 is any free one. Serves one client at a time; the next is served after it has left. The
// serial server itself obeys XOFF.
Result<std::unique_ptr<HostEnd>> open_tcp_end(const Strand& strand, int port);

}  // namespace axisgate::rml1::simulator
