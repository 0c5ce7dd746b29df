// Controller's line in the minimal gateway: a queue, one exchange in flight, no time limit, no check of replies.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <string>
#include <thread>

#include "device/link/asio.h"

namespace axisgate::bench {

// A MinimalLine sends command lines to a controller and passes on the replies. Its code is frozen: see
// minimal_server.cc.
class MinimalLine {
 public:
  using OnReply = std::function<void(const std::string& reply)>;

  // Throws if the tty cannot be opened.
  explicit MinimalLine(const std::string& tty);
  ~MinimalLine();
  MinimalLine(const MinimalLine&) = delete;
  MinimalLine& operator=(const MinimalLine&) = delete;

  // Queues a line. Thread safe. `on_reply` is called on the thread of this MinimalLine.
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
  std::deque<Exchange> exchanges_;  // the first exchange is in flight
  std::array<char, 256> buffer_;
  std::string received_;
  std::thread thread_;
};

}  // namespace axisgate::bench
