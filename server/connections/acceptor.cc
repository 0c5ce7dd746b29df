#include "server/connections/acceptor.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include "server/connections/callers.h"
#include "server/limits.h"
#include "server/log.h"

namespace axisgate::server {
namespace {

bool is_out_of_descriptors(int error) {
  return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
}

// Reports an error that is not the listener's: the client has gone, or the call was interrupted.
bool is_passing(int error) {
  return error == EAGAIN || error == EINTR || error == ECONNABORTED || error == EPROTO || error == EPERM;
}

}  // namespace

Acceptor::Acceptor(Strand strand, ConnectionLimits limits, OnConnection on_connection, Accept accept)
    : strand_(std::move(strand)),
      limits_(limits),
      on_connection_(std::move(on_connection)),
      accept_(std::move(accept)),
      open_(limits.open, limits.of_one),
      reserve_(limits.reserve),
      timer_(strand_) {}

int Acceptor::accept_connection(int listener) {
  const int connection = ::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  // Fails on a Unix socket, which does not need it.
  const int on = 1;
  if (connection >= 0) ::setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return connection;
}

void Acceptor::listen(Descriptor listener, Origin origin) {
  Listener& added = listeners_.emplace_back(Listener{boost::asio::posix::stream_descriptor(strand_), origin});
  added.socket.assign(listener.release());
  wait(added);
}

void Acceptor::close() {
  boost::system::error_code ignored;
  for (Listener& listener : listeners_) listener.socket.close(ignored);
  paused_.clear();
  timer_.cancel();
}

ConnectionCounts Acceptor::counts() {
  return {open_.count(), in_reserve_, accepted_, reserved_, displaced_, out_of_descriptors_};
}

void Acceptor::wait(Listener& listener) {
  listener.socket.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                             [this, &listener](const boost::system::error_code& error) {
                               if (error == boost::asio::error::operation_aborted) return;
                               if (!error && accept_one(listener) == Next::wait) {
                                 wait(listener);
                               } else {
                                 paused_.push_back(&listener);
                                 look_again_later();
                               }
                             });
}

Acceptor::Next Acceptor::accept_one(Listener& listener) {
  if (!open_.has_room()) {
    warn_seldom(fmt::format("as many connections are open as are allowed: {}", limits_.open));
    return accept_reserved(listener);
  }
  // The reserve is filled first: descriptors that its connections free are not for ordinary connections, or it would
  // shrink.
  if (!reserve_.restore()) return accept_out_of_descriptors(listener, EMFILE);
  Descriptor connection(accept_(listener.socket.native_handle()));
  const int error = errno;
  if (connection.valid()) {
    take_in(std::move(connection), listener.origin);
    return Next::wait;
  }
  if (is_out_of_descriptors(error)) return accept_out_of_descriptors(listener, error);
  return is_passing(error) ? Next::wait : Next::pause;
}

Acceptor::Next Acceptor::accept_out_of_descriptors(Listener& listener, int error) {
  ++out_of_descriptors_;
  warn_seldom(
      fmt::format("no descriptors are free ({}); raise the limit of open files (ulimit -n, or LimitNOFILE= of "
                  "the service)",
                  std::generic_category().message(error)));
  return accept_reserved(listener);
}

Acceptor::Next Acceptor::accept_reserved(Listener& listener) {
  look_again_later();
  if (!reserve_.open_place()) return Next::pause;
  displaced_ = reserve_.displaced();
  Descriptor connection(accept_(listener.socket.native_handle()));
  const int error = connection.valid() ? 0 : errno;
  if (connection.valid()) take_into_reserve(std::move(connection), listener.origin);
  return error == 0 || is_passing(error) ? Next::wait : Next::pause;
}

void Acceptor::take_in(Descriptor connection, Origin origin) {
  std::string owner = connection_owner(connection.get());
  if (open_.has_room_for(owner)) {
    open_.add(connection.get(), std::move(owner));
    hand_over(std::move(connection), Service::all, origin);
    return;
  }
  warn_seldom(fmt::format("{} has as many connections open as one caller may: {}", owner, limits_.of_one));
  look_again_later();
  // There is a place: the reserve was full of spare descriptors before this connection was accepted.
  reserve_.open_place();
  displaced_ = reserve_.displaced();
  take_into_reserve(std::move(connection), origin);
}

// The place must already be open.
void Acceptor::take_into_reserve(Descriptor connection, Origin origin) {
  reserve_.keep(connection.get());
  in_reserve_ = reserve_.connections();
  ++reserved_;
  hand_over(std::move(connection), Service::stop_only, origin);
}

void Acceptor::hand_over(Descriptor connection, Service service, Origin origin) {
  ++accepted_;
  on_connection_(std::move(connection), service, origin);
}

void Acceptor::warn_seldom(const std::string& what) {
  if (warning_.due()) log::warn("{}; a new connection gets a stop through, nothing else", what);
}

void Acceptor::look_again_later() {
  if (std::exchange(timer_runs_, true)) return;
  timer_.expires_after(kAcceptAgain);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) look_again();
  });
}

void Acceptor::look_again() {
  timer_runs_ = false;
  const bool restored = reserve_.restore();
  in_reserve_ = reserve_.connections();
  if (!restored || in_reserve_ > 0) look_again_later();
  for (Listener* listener : std::exchange(paused_, {})) wait(*listener);
}

}  // namespace axisgate::server
