// The raw port of a serial server: a controller's line at the other end of a TCP connection.
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

// From the asking for the name to the connection. A host with several addresses gets it shared out among them.
inline constexpr Duration kConnectLimit = std::chrono::seconds(5);

// A host that has silently gone is noticed within about 11 s when nothing is sent, and 5 s after what is sent.
inline constexpr std::chrono::milliseconds kUnacknowledgedLimit{5000};
inline constexpr std::chrono::seconds kKeepAliveIdle{5}, kKeepAliveInterval{2};
inline constexpr int kKeepAliveProbes = 3;

// Each attempt looks up the name again and connects again. Failures are link_down, with a message for people:
// connection refused, the host is not known, no answer, unreachable.
Opener tcp_opener(TcpSettings settings);

}  // namespace axisgate
