// Spare descriptors, with which a connection for a stop is accepted when no others are free.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "device/link/descriptor.h"

namespace axisgate::server {

// Keeps spare descriptors open for its connections, and closes two of them before each new connection. A new connection
// displaces the oldest, so that a program that opens connections and leaves them open does not fill the reserve. Not
// thread safe.
class Reserve {
 public:
  // `places`: connections at once, at least 1. If no descriptors are free, the reserve starts empty and restore() fills
  // it.
  explicit Reserve(std::size_t places);

  // Frees the descriptors for one connection, which must be accepted next. Returns false if there are none yet, since a
  // displaced connection takes a moment to close.
  bool open_place();
  // Keeps a second descriptor of a connection just accepted, to detect its end and to displace it. If no descriptor is
  // free, the connection is not tracked.
  void keep(int connection);
  // Takes back the descriptors of ended connections. Returns false if spare descriptors are still missing.
  bool restore();
  std::size_t connections() const { return connections_.size(); }  // as of the last call of a function above

  std::uint64_t displaced() const { return displaced_; }  // since the start

 private:
  // The server side has one descriptor of a connection, the reserve another.
  static constexpr std::size_t kDescriptorsEach = 2;

  void forget_ended();

  const std::size_t places_;
  std::deque<Descriptor> connections_;  // the oldest first
  std::vector<Descriptor> spare_;
  std::uint64_t displaced_ = 0;
};

}  // namespace axisgate::server
