#include "server/connections/descriptor_limit.h"

#include <sys/resource.h>

#include <algorithm>

namespace axisgate::server {
namespace {

// Each connection costs about 100 kB.
constexpr std::size_t kConnectionsMax = 4096;
// An idle daemon with one device has about 55 descriptors open, including the reserve's. The metrics page may have up
// to its limit of 128 connections.
constexpr std::size_t kSetAside = 320;
// The client's connection, and both ends of its connection to gRPC.
constexpr std::size_t kDescriptorsEach = 3;

}  // namespace

std::size_t connections_within(std::size_t descriptors) {
  // With a very low limit, half of the descriptors serve connections. The reserve remains when they run out.
  const std::size_t left = descriptors > 2 * kSetAside ? descriptors - kSetAside : descriptors / 2;
  return std::min(left / kDescriptorsEach, kConnectionsMax);
}

std::size_t raise_descriptor_limit() {
  constexpr rlim_t kUseful = kConnectionsMax * kDescriptorsEach + kSetAside;
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur < kUseful && limit.rlim_cur < limit.rlim_max) {
    rlimit raised{std::min(kUseful, limit.rlim_max), limit.rlim_max};
    if (::setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
  }
  return connections_within(limit.rlim_cur);
}

}  // namespace axisgate::server
