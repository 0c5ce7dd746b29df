#include "server/connections/acceptor.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

namespace axisgate::server {
namespace {

// How long a listener rests that could not accept, and how often ended connections of the reserve are looked for.
constexpr auto kLookAgain = std::chrono::milliseconds(50);

bool is_out_of_descriptors(int error) {
  return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
}

// Nothing is wrong with the listener: nobody was there any more, or we were interrupted.
bool is_passing(int error) {
  return error == EAGAIN || error == EINTR || error == ECONNABORTED || error == EPROTO || error == EPERM;
}

}  // namespace

Acceptor::Acceptor(Strand strand, ConnectionLimits limits, OnConnection on_connection, Accept accept)
    : strand_(std::move(strand)),
      limits_(limits),
      on_connection_(std::move(on_connection)),
      accept_(std::move(accept)),
      open_(limits.open),
      reserve_(limits.reserve),
      timer_(strand_) {}

int Acceptor::accept_connection(int listener) {
  const int connection = ::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  // A Unix socket refuses it, and needs none.
  const int on = 1;
  if (connection >= 0) ::setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return connection;
}

void Acceptor::listen(Descriptor listener) {
  Listener& added = listeners_.emplace_back(strand_);
  added.assign(listener.release());
  wait(added);
}

ConnectionCounts Acceptor::counts() { return {open_.count(), accepted_, reserved_, displaced_, out_of_descriptors_}; }

void Acceptor::wait(Listener& listener) {
  listener.async_wait(Listener::wait_read, [this, &listener](const boost::system::error_code& error) {
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
    if (tell_reserved_.due()) {
      spdlog::warn("{} connections are open, and no more are served: a new one gets a stop through, nothing else",
                   limits_.open);
    }
    return accept_reserved(listener);
  }
  Descriptor connection(accept_(listener.native_handle()));
  if (connection.valid()) {
    open_.add(connection.get());
    hand_over(std::move(connection), Service::all);
    return Next::wait;
  }
  const int error = errno;
  if (!is_out_of_descriptors(error)) return is_passing(error) ? Next::wait : Next::pause;
  ++out_of_descriptors_;
  if (tell_reserved_.due()) {
    spdlog::warn(
        "no descriptors are free ({}): a new connection gets a stop through, nothing else; raise the limit of "
        "open files (ulimit -n, or LimitNOFILE= of the service)",
        std::generic_category().message(error));
  }
  return accept_reserved(listener);
}

Acceptor::Next Acceptor::accept_reserved(Listener& listener) {
  reserve_.open_place();
  displaced_ = reserve_.displaced();
  Descriptor connection(accept_(listener.native_handle()));
  const int error = connection.valid() ? 0 : errno;
  if (connection.valid()) {
    reserve_.keep(connection.get());
    ++reserved_;
    hand_over(std::move(connection), Service::stop_only);
  }
  look_again_later();
  return error == 0 || is_passing(error) ? Next::wait : Next::pause;
}

void Acceptor::hand_over(Descriptor connection, Service service) {
  ++accepted_;
  on_connection_(std::move(connection), service);
}

void Acceptor::look_again_later() {
  if (std::exchange(timer_runs_, true)) return;
  timer_.expires_after(kLookAgain);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) look_again();
  });
}

void Acceptor::look_again() {
  timer_runs_ = false;
  if (!reserve_.restore()) look_again_later();
  for (Listener* listener : std::exchange(paused_, {})) wait(*listener);
}

}  // namespace axisgate::server
