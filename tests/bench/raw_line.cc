#include "tests/bench/raw_line.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace axisgate::bench {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

[[noreturn]] void fail(const std::string& what) { throw std::system_error(errno, std::generic_category(), what); }

sockaddr_in address_of(const std::string& text) {
  const auto colon = text.rfind(':');
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(text.substr(colon + 1))));
  if (::inet_pton(AF_INET, text.substr(0, colon).c_str(), &address.sin_addr) != 1) {
    throw std::runtime_error(text + " is not an IPv4 address with a port");
  }
  return address;
}

}  // namespace

RawLine RawLine::open_tty(const std::string& path) {
  Descriptor tty(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios mode{};
  if (!tty.valid() || ::tcgetattr(tty.get(), &mode) != 0) fail(path);
  ::cfmakeraw(&mode);
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  if (::tcsetattr(tty.get(), TCSANOW, &mode) != 0 || ::tcflush(tty.get(), TCIFLUSH) != 0) fail(path);
  return RawLine(std::move(tty));
}

RawLine RawLine::connect_tcp(const std::string& text) {
  const sockaddr_in address = address_of(text);
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const timeval limit{.tv_sec = 0, .tv_usec = 500'000};
  const int on = 1;
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof(limit)) != 0 ||
      ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on)) != 0) {
    fail(text);
  }
  return RawLine(std::move(socket));
}

std::optional<std::string> RawLine::ask(std::string_view line) {
  const std::string sent = std::string(line).append(kLineEnd);
  if (::write(descriptor_.get(), sent.data(), sent.size()) != static_cast<ssize_t>(sent.size())) fail("write");
  std::array<char, 512> buffer;
  std::size_t end = received_.find(kLineEnd);
  while (end == std::string::npos) {
    const ssize_t size = ::read(descriptor_.get(), buffer.data(), buffer.size());
    if (size < 0 && errno == EAGAIN) return std::nullopt;
    if (size <= 0) fail("read");
    received_.append(buffer.data(), static_cast<std::size_t>(size));
    end = received_.find(kLineEnd);
  }
  std::string answer = received_.substr(0, end);
  received_.erase(0, end + kLineEnd.size());
  return answer;
}

void RawLine::discard_received() {
  received_.clear();
  int waiting = 0;
  while (::ioctl(descriptor_.get(), FIONREAD, &waiting) == 0 && waiting > 0) {
    std::array<char, 512> buffer;
    if (::read(descriptor_.get(), buffer.data(), buffer.size()) <= 0) fail("read");
  }
}

}  // namespace axisgate::bench
