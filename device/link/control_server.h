// Serves the clients of the control socket: each line receives one reply line.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/link/asio.h"
#include "device/link/descriptor.h"

namespace axisgate {

// A ControlServer carries out a client's commands one after another, each after the client has taken the previous
// reply. A client that is silent, or reads no replies, therefore blocks only itself and costs some kilobytes. All
// members must be called on the strand, or while no thread runs its io_context. Call shutdown() before releasing the
// last pointer.
class ControlServer : public std::enable_shared_from_this<ControlServer> {
 public:
  // Maximum number of connections. A further connection closes the one that has been silent for longest, so that leaked
  // connections do not keep new clients out.
  static constexpr std::size_t kConnectionsMax = 32;

  using Reply = std::function<void(const std::string& line)>;
  // Carries out a command, given without its end of line, and calls `reply` on the strand after it has returned.
  using CarryOut = std::function<void(const std::string& line, Reply reply)>;

  ControlServer(Strand strand, Descriptor listener, CarryOut carry_out);
  ~ControlServer();

  void start();
  void shutdown();  // closes everything; commands not yet carried out receive no reply

 private:
  class Connection;

  void wait();
  void accept_one();
  void make_room();

  Strand strand_;
  boost::asio::posix::stream_descriptor listener_;
  boost::asio::steady_timer pause_;
  CarryOut carry_out_;
  std::vector<std::shared_ptr<Connection>> open_;  // ordered by their last command
};

}  // namespace axisgate
