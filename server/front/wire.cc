#include "server/front/wire.h"

#include <utility>

namespace axisgate::front {
namespace {

class PlainWire final : public Wire {
 public:
  explicit PlainWire(Socket socket) : socket_(std::move(socket)) {
    Error ignored;
    socket_.non_blocking(true, ignored);
  }

  void read_some(OnBytes handler) override {
    socket_.async_wait(Socket::wait_read, [this, handler = std::move(handler)](Error error) mutable {
      if (error) return handler(error, {});
      std::string bytes(kPiece, '\0');
      const std::size_t size = socket_.read_some(boost::asio::buffer(bytes), error);
      if (error == boost::asio::error::would_block) return read_some(std::move(handler));
      bytes.resize(size);
      handler(error, std::move(bytes));
    });
  }
  void write(boost::asio::const_buffer bytes, std::function<void(Error)> handler) override {
    boost::asio::async_write(socket_, bytes,
                             [handler = std::move(handler)](const Error& error, std::size_t) { handler(error); });
  }
  void close() override {
    Error ignored;
    // The reserve keeps another descriptor of the socket.
    socket_.shutdown(Socket::shutdown_both, ignored);
    socket_.close(ignored);
  }

 private:
  Socket socket_;
};

}  // namespace

std::unique_ptr<Wire> plain_wire(Socket socket) { return std::make_unique<PlainWire>(std::move(socket)); }

}  // namespace axisgate::front
