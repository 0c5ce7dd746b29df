// Readers of the metrics page, some like Prometheus and some not.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include "device/link/descriptor.h"

namespace axisgate::server {

// A connection to the page. No wait lasts longer than 20 s.
class PageReader {
 public:
  // Options of a reader that is not connected yet: size of the receive buffer in bytes, 0 for the system's default.
  struct Unconnected {
    int receive_buffer = 0;
  };
  explicit PageReader(Unconnected made) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval limit{20, 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    if (made.receive_buffer > 0) {
      ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &made.receive_buffer, sizeof made.receive_buffer);
    }
  }
  explicit PageReader(int port) : PageReader(Unconnected{}) { connect(port); }

  void connect(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }

  bool connected() const { return connected_; }

  bool send(std::string_view text) {
    return ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }

  // Reads until the connection ends, with a pause after each piece, and returns everything received.
  std::string read_to_end(std::chrono::milliseconds pause = {}) {
    while (read_more()) std::this_thread::sleep_for(pause);
    return received_;
  }

  // Reads one answer with the announced length of its body, ignoring later bytes; returns less if the connection ends.
  std::string read_answer() {
    std::size_t head = 0;
    while ((head = received_.find("\r\n\r\n")) == std::string::npos && read_more()) {
    }
    constexpr std::string_view kLength = "Content-Length: ";
    const std::size_t length = received_.find(kLength);
    const std::size_t end =
        length < head ? head + 4 + std::stoul(received_.substr(length + kLength.size())) : received_.size();
    while (received_.size() < end && read_more()) {
    }
    const std::string answer = received_.substr(0, end);
    received_.erase(0, end);
    return answer;
  }

  // Waits for another piece; returns false at the end of the connection or after the time limit.
  bool read_more() {
    std::array<char, 16384> piece;
    const ssize_t size = ::read(socket_.get(), piece.data(), piece.size());
    timed_out_ = size < 0 && errno == EAGAIN;
    if (size <= 0) return false;
    received_.append(piece.data(), static_cast<std::size_t>(size));
    return true;
  }

  // Reports whether the page closes the connection without sending another byte.
  bool is_ended() { return received_.empty() && !read_more() && !timed_out_; }

 private:
  const Descriptor socket_;
  bool connected_ = false;
  bool timed_out_ = false;
  std::string received_;
};

// Requests /metrics and returns the answer, or a text that says what went wrong.
inline std::string metrics_page(int port) {
  PageReader reader(port);
  if (!reader.connected()) return "no connection";
  if (!reader.send("GET /metrics HTTP/1.0\r\n\r\n")) return "the connection broke";
  return reader.read_to_end();
}

}  // namespace axisgate::server
