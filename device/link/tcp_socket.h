// Raw port of a serial server: a controller's line at the other end of a TCP connection.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "device/core/time.h"
#include "device/link/opener.h"

namespace axisgate {

struct TcpSettings {
  std::string host;  // a name, or an IPv4 or IPv6 address without brackets
  std::uint16_t port = 0;
};
std::string to_string(const TcpSettings& settings);  // "moxa.lab:4001", "[fe80::1]:4001"

// Time from the lookup of the name to the connection. It is divided among the addresses of a host that has several.
inline constexpr Duration kConnectLimit = std::chrono::seconds(5);

// A host that vanished is noticed within about 11 s if nothing is sent, and 5 s after bytes that were sent.
inline constexpr std::chrono::milliseconds kUnacknowledgedLimit{5000};
inline constexpr std::chrono::seconds kKeepAliveIdle{5}, kKeepAliveInterval{2};
inline constexpr int kKeepAliveProbes = 3;

// Each attempt looks up the name again and connects again. Fails with link_down and a message for people: connection
// refused, host not known, no answer, or unreachable.
Opener tcp_opener(TcpSettings settings);

}  // namespace axisgate
