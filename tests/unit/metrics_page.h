// The metrics page as Prometheus gets it.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>

#include "device/link/descriptor.h"

namespace axisgate::server {

// Asks for /metrics and returns the answer, or what went wrong in its place.
inline std::string metrics_page(int port) {
  const Descriptor page(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(page.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return "no connection";
  const std::string request = "GET /metrics HTTP/1.0\r\n\r\n";
  if (::send(page.get(), request.data(), request.size(), MSG_NOSIGNAL) < 0) return "the connection broke";
  std::string text;
  std::array<char, 16384> piece;
  for (ssize_t size = 0; (size = ::read(page.get(), piece.data(), piece.size())) > 0;) {
    text.append(piece.data(), static_cast<std::size_t>(size));
  }
  return text;
}

}  // namespace axisgate::server
