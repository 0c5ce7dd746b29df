// The bytes of one client's connection, plain or through TLS.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "device/link/asio.h"

namespace axisgate::front {

// Used on one strand. A handler that has not been called when the wire is closed is called with an error.
class Wire {
 public:
  using Error = boost::system::error_code;
  using OnBytes = std::function<void(const Error&, std::string bytes)>;

  virtual ~Wire() = default;

  // Reads at most kPiece bytes, at least one without an error. A plain wire keeps no buffer while it waits.
  virtual void read_some(OnBytes handler) = 0;
  // Writes all bytes, which must stay valid until the handler is called.
  virtual void write(boost::asio::const_buffer bytes, std::function<void(Error)> handler) = 0;
  virtual void close() = 0;

 protected:
  static constexpr std::size_t kPiece = 16 * 1024;
};

using Socket = boost::asio::generic::stream_protocol::socket;

std::unique_ptr<Wire> plain_wire(Socket socket);

}  // namespace axisgate::front
