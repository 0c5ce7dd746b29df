#include "server/front/wire.h"

#include <utility>

namespace axisgate::front {
namespace {

class PlainWire final : public Wire {
 public:
  explicit PlainWire(Socket socket) : socket_(std::move(socket)) {}

  void read_some(boost::asio::mutable_buffer buffer, std::function<void(Error, std::size_t)> handler) override {
    socket_.async_read_some(buffer, std::move(handler));
  }
  void write(boost::asio::const_buffer bytes, std::function<void(Error)> handler) override {
    boost::asio::async_write(socket_, bytes,
                             [handler = std::move(handler)](const Error& error, std::size_t) { handler(error); });
  }
  void close() override {
    Error ignored;
    // The reserve holds another descriptor of it.
    socket_.shutdown(Socket::shutdown_both, ignored);
    socket_.close(ignored);
  }

 private:
  Socket socket_;
};

}  // namespace

std::unique_ptr<Wire> plain_wire(Socket socket) { return std::make_unique<PlainWire>(std::move(socket)); }

}  // namespace axisgate::front
