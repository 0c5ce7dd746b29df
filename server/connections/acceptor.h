// Accepts connections as long as the daemon runs, even without free descriptors.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "device/core/time.h"
#include "device/link/asio.h"
#include "device/link/descriptor.h"
#include "server/connections/open_connections.h"
#include "server/connections/reserve.h"
#include "server/connections/seldom.h"

namespace axisgate::server {

struct ConnectionLimits {
  std::size_t open = 0;     // at once, without those in the reserve
  std::size_t reserve = 8;  // further connections beyond `open` or `of_one`, or without free descriptors; at least 1
  std::size_t of_one = std::numeric_limits<std::size_t>::max();  // open connections of one owner (callers.h)
};

struct ConnectionCounts {
  std::size_t open = 0;                  // now, without those in the reserve
  std::size_t in_reserve = 0;            // now
  std::uint64_t accepted = 0;            // since the start, including those in the reserve
  std::uint64_t reserved = 0;            // accepted into the reserve
  std::uint64_t displaced = 0;           // closed in the reserve for a newer one
  std::uint64_t out_of_descriptors = 0;  // attempts to accept that found no free descriptor
};

// Use on its strand, except for counts().
class Acceptor {
 public:
  enum class Service { all, stop_only };
  // Kind of the listener through which the client connected.
  enum class Origin { this_machine, network };
  // Receives a non-blocking connection, which the receiver closes.
  using OnConnection = std::function<void(Descriptor connection, Service service, Origin origin)>;
  // Works like accept(2): returns a descriptor, or -1 with errno set.
  using Accept = std::function<int(int listener)>;

  Acceptor(Strand strand, ConnectionLimits limits, OnConnection on_connection, Accept accept = accept_connection);

  // Accepts on this non-blocking listening socket as well.
  void listen(Descriptor listener, Origin origin = Origin::this_machine);

  // Stops accepting on all listeners.
  void close();

  ConnectionCounts counts();  // thread safe

  static int accept_connection(int listener);

 private:
  struct Listener {
    boost::asio::posix::stream_descriptor socket;
    Origin origin;
  };
  enum class Next { wait, pause };

  void wait(Listener& listener);
  Next accept_one(Listener& listener);
  Next accept_out_of_descriptors(Listener& listener, int error);
  Next accept_reserved(Listener& listener);
  void take_in(Descriptor connection, Origin origin);
  void take_into_reserve(Descriptor connection, Origin origin);
  void hand_over(Descriptor connection, Service service, Origin origin);
  void warn_seldom(const std::string& what);
  void look_again_later();
  void look_again();

  const Strand strand_;
  const ConnectionLimits limits_;
  const OnConnection on_connection_;
  const Accept accept_;
  OpenConnections open_;
  Reserve reserve_;
  std::deque<Listener> listeners_;
  std::vector<Listener*> paused_;
  boost::asio::steady_timer timer_;
  bool timer_runs_ = false;
  Seldom warning_;
  std::atomic<std::size_t> in_reserve_ = 0;
  std::atomic<std::uint64_t> accepted_ = 0;
  std::atomic<std::uint64_t> reserved_ = 0;
  std::atomic<std::uint64_t> displaced_ = 0;
  std::atomic<std::uint64_t> out_of_descriptors_ = 0;
};

}  // namespace axisgate::server
