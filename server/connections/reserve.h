// Descriptors kept back so that a connection with a stop is accepted when there are none left for others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "device/link/descriptor.h"

namespace axisgate::server {

// Holds as many descriptors open as its connections will need, and closes those of one of them when it comes. A
// newcomer displaces the connection that has been there longest, so that a program that opens connections and leaves
// them open does not fill the reserve. Not thread safe.
class Reserve {
 public:
  // For this many connections at once, 1 at least. Without free descriptors it begins empty and fills itself by
  // restore().
  explicit Reserve(std::size_t places);

  // Frees what one connection needs: accept it next. False when that is not there yet, since a displaced connection
  // takes a moment to be closed.
  bool open_place();
  // Keeps a second descriptor of a connection that was just accepted, by which its end is seen and it is displaced.
  // Without a free one the connection is left to end by itself.
  void keep(int connection);
  // Takes back what ended connections have left. False as long as it has not all that further connections need.
  bool restore();
  std::size_t connections() const { return connections_.size(); }  // as of the last of the calls above

  std::uint64_t displaced() const { return displaced_; }  // since the start

 private:
  // The server side of a connection holds one descriptor of it, the reserve another.
  static constexpr std::size_t kDescriptorsEach = 2;

  void forget_ended();

  const std::size_t places_;
  std::deque<Descriptor> connections_;  // the oldest first
  std::vector<Descriptor> spare_;
  std::uint64_t displaced_ = 0;
};

}  // namespace axisgate::server
