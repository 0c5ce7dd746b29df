// A controller's line in the smallest gateway: a queue, one exchange in flight, no time limit, no judgement.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <string>
#include <thread>

#include "device/link/asio.h"

namespace axisgate::bench {

// Frozen, as minimal_server.cc says.
class MinimalLine {
 public:
  using OnReply = std::function<void(const std::string& reply)>;

  // Throws where the tty cannot be opened.
  explicit MinimalLine(const std::string& tty);
  ~MinimalLine();
  MinimalLine(const MinimalLine&) = delete;
  MinimalLine& operator=(const MinimalLine&) = delete;

  // From any thread. `on_reply` is called on the line's own thread.
  void ask(std::string line, OnReply on_reply);

 private:
  struct Exchange {
    std::string line;
    OnReply on_reply;
  };

  void send_next();
  void read();
  void take(std::size_t size);

  boost::asio::io_context context_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  boost::asio::posix::stream_descriptor tty_;
  std::deque<Exchange> exchanges_;  // the first is in flight
  std::array<char, 256> buffer_;
  std::string received_;
  std::thread thread_;
};

}  // namespace axisgate::bench
