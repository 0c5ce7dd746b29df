// Lines in, one reply line each out, for each client of the control socket.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/link/asio.h"
#include "device/link/descriptor.h"

namespace axisgate {

// A client's commands are carried out one after another, the next once the reply to the last has been taken. So one
// that is silent, or reads no replies, holds up itself alone and costs some kilobytes. All members on the strand, or
// when no thread runs its io_context; shutdown() before the last pointer goes.
class ControlServer : public std::enable_shared_from_this<ControlServer> {
 public:
  // One more, and the connection that has been silent for longest is closed: leaked ones keep nobody out.
  static constexpr std::size_t kConnectionsMax = 32;

  using Reply = std::function<void(const std::string& line)>;
  // Carries out a command, without its end of line, and calls `reply` on the strand, not from within.
  using CarryOut = std::function<void(const std::string& line, Reply reply)>;

  ControlServer(Strand strand, Descriptor listener, CarryOut carry_out);
  ~ControlServer();

  void start();
  void shutdown();  // closes everything; commands that have not been carried out get no reply

 private:
  class Connection;

  void wait();
  void accept_one();
  void make_room();

  Strand strand_;
  boost::asio::posix::stream_descriptor listener_;
  boost::asio::steady_timer pause_;
  CarryOut carry_out_;
  std::vector<std::shared_ptr<Connection>> open_;  // the client that spoke last is last
};

}  // namespace axisgate
