#include "server/metrics/page_session.h"

#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "device/link/clock.h"

namespace axisgate::server {
namespace {

using boost::system::error_code;

using Piece = std::array<char, 4096>;

// Returns the result of recv(2).
ssize_t receive(int socket, Piece& piece) { return ::recv(socket, piece.data(), piece.size(), MSG_DONTWAIT); }

bool is_passing(int error) { return error == EAGAIN || error == EINTR; }

iovec rest_of(std::string_view text, std::size_t sent) {
  const std::string_view rest = text.substr(std::min(sent, text.size()));
  return {const_cast<char*>(rest.data()), rest.size()};
}

// Returns the result of sendmsg(2). Sends `head` and `body` as one text, so that the head needs no packet of its own.
ssize_t send_from(int socket, std::string_view head, std::string_view body, std::size_t sent) {
  std::array<iovec, 2> rests = {rest_of(head, sent), rest_of(body, sent - std::min(sent, head.size()))};
  msghdr message{};
  message.msg_iov = rests.data();
  message.msg_iovlen = rests.size();
  return ::sendmsg(socket, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace

PageSession::PageSession(boost::asio::io_context& context, const PageLimits& limits, TakePageText take_text)
    : limits_(limits), take_text_(std::move(take_text)), socket_(context), limit_(context) {}

void PageSession::start(Descriptor connection) {
  error_code error;
  socket_.assign(connection.get(), error);
  if (error) return;
  connection.release();
  enter(State::asking, limits_.head);
  wait_for(Socket::wait_read, &PageSession::read);
}

void PageSession::end() {
  error_code ignored;
  socket_.close(ignored);
  limit_.cancel();
  answer_ = {};
}

void PageSession::enter(State state, Duration limit) {
  state_ = state;
  since_ = monotonic_now();
  limit_.expires_after(limit);
  limit_.async_wait([self = shared_from_this()](const error_code& error) {
    // An expired timer cannot be cancelled: it may already have been set again for another state.
    if (!error && self->limit_.expiry() <= std::chrono::steady_clock::now()) self->end();
  });
}

void PageSession::wait_for(Socket::wait_type what, void (PageSession::*then)()) {
  socket_.async_wait(what, [self = shared_from_this(), then](const error_code& error) {
    if (error) return self->end();
    if (self->is_open()) ((*self).*then)();
  });
}

void PageSession::read() {
  Piece piece;
  const ssize_t size = receive(socket_.native_handle(), piece);
  if (size == 0 || (size < 0 && !is_passing(errno))) return end();
  if (state_ == State::idle) enter(State::asking, limits_.head);
  if (size > 0) received_.append(piece.data(), static_cast<std::size_t>(size));
  look_for_request();
}

void PageSession::look_for_request() {
  const std::optional<std::size_t> size = head_size(received_);
  if (size.value_or(received_.size()) > limits_.head_bytes) return send(answer_too_long());
  if (!size) return wait_for(Socket::wait_read, &PageSession::read);
  const std::optional<PageRequest> request = parse_request(std::string_view(received_).substr(0, *size));
  received_.erase(0, *size);
  send(request ? answer(*request, take_text_) : answer_malformed());
}

void PageSession::send(PageAnswer answer) {
  answer_ = std::move(answer);
  sent_ = 0;
  enter(State::answering, limits_.answer);
  send_rest();
}

void PageSession::send_rest() {
  const std::string_view body = answer_.body ? std::string_view(*answer_.body) : std::string_view();
  while (sent_ < answer_.head.size() + body.size()) {
    const ssize_t size = send_from(socket_.native_handle(), answer_.head, body, sent_);
    if (size < 0 && is_passing(errno)) return wait_for(Socket::wait_write, &PageSession::send_rest);
    if (size < 0) return end();
    sent_ += static_cast<std::size_t>(size);
  }
  const bool keep_alive = answer_.keep_alive;
  answer_ = {};
  if (keep_alive) {
    stay();
  } else {
    leave();
  }
}

void PageSession::stay() {
  if (received_.empty()) {
    enter(State::idle, limits_.idle);
    return wait_for(Socket::wait_read, &PageSession::read);
  }
  // Part of the next request came with this one. Other connections get their turn first, since one connection may send
  // hundreds of requests at once.
  enter(State::asking, limits_.head);
  boost::asio::post(socket_.get_executor(), [self = shared_from_this()] {
    if (self->is_open()) self->look_for_request();
  });
}

void PageSession::leave() {
  ::shutdown(socket_.native_handle(), SHUT_WR);
  enter(State::leaving, limits_.leaving);
  wait_for(Socket::wait_read, &PageSession::discard);
}

void PageSession::discard() {
  Piece piece;
  const ssize_t size = receive(socket_.native_handle(), piece);
  if (size == 0 || (size < 0 && !is_passing(errno))) return end();
  wait_for(Socket::wait_read, &PageSession::discard);
}

}  // namespace axisgate::server
