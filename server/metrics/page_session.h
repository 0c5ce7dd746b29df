// A connection to the metrics page: reads its requests, sends the answers, and ends when one of its limits passes.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "device/core/time.h"
#include "device/link/asio.h"
#include "device/link/descriptor.h"
#include "server/metrics/page_answer.h"
#include "server/metrics/page_limits.h"

namespace axisgate::server {

// Runs on the context's only thread. Its pending operations keep it alive.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  // `limits` must outlive this object.
  PageSession(boost::asio::io_context& context, const PageLimits& limits, TakePageText take_text);

  // Takes over the non-blocking connection. Call it once.
  void start(Descriptor connection);
  // Closes the connection and discards unsent bytes.
  void end();

  bool is_open() const { return socket_.is_open(); }
  // Reports whether the answer to a complete request is being sent.
  bool is_answering() const { return state_ == State::answering; }
  TimePoint since() const { return since_; }  // begin of the present state

 private:
  enum class State { asking, answering, idle, leaving };
  using Socket = boost::asio::posix::stream_descriptor;

  void enter(State state, Duration limit);
  void wait_for(Socket::wait_type what, void (PageSession::*then)());
  void read();
  void look_for_request();
  void send(PageAnswer answer);
  void send_rest();
  void stay();
  void leave();
  void discard();

  const PageLimits& limits_;
  const TakePageText take_text_;
  Socket socket_;
  boost::asio::steady_timer limit_;
  State state_ = State::asking;
  TimePoint since_{};
  std::string received_;  // not answered yet
  PageAnswer answer_;
  std::size_t sent_ = 0;  // of head and body
};

}  // namespace axisgate::server
