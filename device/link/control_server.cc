#include "device/link/control_server.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <deque>
#include <string_view>
#include <utility>

#include "device/core/control_language.h"

namespace axisgate {
namespace {

// Pause after a failure to accept a connection, such as when no descriptor is free.
constexpr auto kPause = std::chrono::milliseconds(100);

constexpr std::string_view kUnended = "error: the last line has no end; end each line with a line feed\n";

bool would_block(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

class ControlServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(ControlServer& server, Descriptor socket) : server_(server), socket_(server.strand_, socket.release()) {}

  void look();
  void close() { socket_.close(); }
  bool closed() const { return !socket_.is_open(); }

 private:
  using Stream = boost::asio::posix::stream_descriptor;

  bool write_replies();
  bool read_some();
  void take_in(std::string_view bytes);
  void carry_out_next();
  void wait_for(Stream::wait_type what);
  void leave();

  ControlServer& server_;  // closes this connection before it ends
  Stream socket_;
  std::string line_;               // the line up to now, cut where it is known to be too long
  std::deque<std::string> lines_;  // complete lines of one read
  std::string replies_;            // replies that the client has not taken yet
  bool carrying_out_ = false;
  bool ended_ = false;  // the client sends no more
};

// Does everything that is possible without waiting, but reads at most once, so that a client that never stops sending
// leaves time for others.
void ControlServer::Connection::look() {
  if (closed() || carrying_out_) return;
  if (!write_replies()) return;
  if (!lines_.empty()) {
    carry_out_next();
  } else if (ended_) {
    leave();
  } else if (read_some()) {
    boost::asio::post(server_.strand_, [self = shared_from_this()] { self->look(); });
  }
}

bool ControlServer::Connection::write_replies() {
  while (!replies_.empty()) {
    const ssize_t sent = ::send(socket_.native_handle(), replies_.data(), replies_.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      replies_.erase(0, static_cast<std::size_t>(sent));
    } else if (would_block(errno)) {
      wait_for(Stream::wait_write);
      return false;
    } else {
      leave();
      return false;
    }
  }
  return true;
}

// Returns false if the connection must wait or has ended.
bool ControlServer::Connection::read_some() {
  std::array<char, 4096> buffer;
  const ssize_t size = ::recv(socket_.native_handle(), buffer.data(), buffer.size(), 0);
  if (size > 0) {
    take_in({buffer.data(), static_cast<std::size_t>(size)});
    return true;
  }
  if (size < 0 && would_block(errno)) {
    wait_for(Stream::wait_read);
    return false;
  }
  if (size < 0) {
    leave();
    return false;
  }
  // A line without an end may be one half of another command.
  ended_ = true;
  if (!line_.empty()) replies_ += kUnended;
  return true;
}

void ControlServer::Connection::take_in(std::string_view bytes) {
  // One more for the CR of clients that end lines with CR LF, and one more to show that a line is too long.
  constexpr std::size_t kKept = kControlLineMax + 2;
  for (const char byte : bytes) {
    if (byte == '\n') {
      if (line_.ends_with('\r')) line_.pop_back();
      lines_.push_back(std::exchange(line_, {}));
    } else if (line_.size() < kKept) {
      line_ += byte;
    }
  }
}

void ControlServer::Connection::carry_out_next() {
  const std::string line = std::move(lines_.front());
  lines_.pop_front();
  const auto self = shared_from_this();
  // Moves the connection to the end of the list, whose first connection is closed when room is needed.
  auto& open = server_.open_;
  std::rotate(std::find(open.begin(), open.end(), self), std::find(open.begin(), open.end(), self) + 1, open.end());
  carrying_out_ = true;
  server_.carry_out_(line, [self](const std::string& reply) {
    self->carrying_out_ = false;
    self->replies_ += reply + '\n';
    self->look();
  });
}

void ControlServer::Connection::wait_for(Stream::wait_type what) {
  socket_.async_wait(what, [self = shared_from_this()](const boost::system::error_code& error) {
    if (!error) self->look();
  });
}

void ControlServer::Connection::leave() {
  close();
  std::erase(server_.open_, shared_from_this());
}

ControlServer::ControlServer(Strand strand, Descriptor listener, CarryOut carry_out)
    : strand_(std::move(strand)),
      listener_(strand_, listener.release()),
      pause_(strand_),
      carry_out_(std::move(carry_out)) {}

ControlServer::~ControlServer() = default;

void ControlServer::start() { wait(); }

void ControlServer::shutdown() {
  listener_.close();
  pause_.cancel();
  for (const auto& connection : open_) connection->close();
  open_.clear();
}

void ControlServer::wait() {
  listener_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [self = shared_from_this()](const boost::system::error_code& error) {
                         if (!error) self->accept_one();
                       });
}

void ControlServer::accept_one() {
  Descriptor socket(::accept4(listener_.native_handle(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!socket.valid() && !would_block(errno) && errno != ECONNABORTED) {
    pause_.expires_after(kPause);
    pause_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
      if (!error) self->wait();
    });
    return;
  }
  if (socket.valid()) {
    make_room();
    open_.push_back(std::make_shared<Connection>(*this, std::move(socket)));
    open_.back()->look();
  }
  wait();
}

void ControlServer::make_room() {
  if (open_.size() < kConnectionsMax) return;
  open_.front()->close();
  open_.erase(open_.begin());
}

}  // namespace axisgate
