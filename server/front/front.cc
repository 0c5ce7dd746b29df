#include "server/front/front.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "server/access/access.h"
#include "server/connections/callers.h"
#include "server/limits.h"

namespace axisgate::front {
namespace {

// Detects within a minute that a client has disappeared without closing the connection.
void notice_silence(int connection) {
  constexpr int kYes = 1, kIdleSeconds = 20, kBetweenSeconds = 10, kTries = 3, kUntakenMilliseconds = 50'000;
  ::setsockopt(connection, SOL_SOCKET, SO_KEEPALIVE, &kYes, sizeof kYes);
  ::setsockopt(connection, IPPROTO_TCP, TCP_KEEPIDLE, &kIdleSeconds, sizeof kIdleSeconds);
  ::setsockopt(connection, IPPROTO_TCP, TCP_KEEPINTVL, &kBetweenSeconds, sizeof kBetweenSeconds);
  ::setsockopt(connection, IPPROTO_TCP, TCP_KEEPCNT, &kTries, sizeof kTries);
  ::setsockopt(connection, IPPROTO_TCP, TCP_USER_TIMEOUT, &kUntakenMilliseconds, sizeof kUntakenMilliseconds);
}

Socket socket_of(const Strand& strand, Descriptor connection) {
  int family = 0;
  socklen_t size = sizeof(family);
  ::getsockopt(connection.get(), SOL_SOCKET, SO_DOMAIN, &family, &size);
  const int protocol = family == AF_UNIX ? 0 : static_cast<int>(IPPROTO_TCP);
  if (family != AF_UNIX) notice_silence(connection.get());
  Socket socket(strand);
  socket.assign(boost::asio::generic::stream_protocol(family, protocol), connection.get());
  (void)connection.release();
  return socket;
}

}  // namespace

Front::Front(Strand strand, CallFilter& filter, const std::optional<server::NetworkConfig>& network,
             std::function<void(Descriptor)> to_grpc, OnClosing on_closing, const FrontLimits& limits)
    : limits_(limits),
      sources_(limits.source),
      held_(limits.held_bytes),
      on_closing_(std::move(on_closing)),
      around_{strand,
              std::make_shared<Inbox>(strand),
              {filter, limits_, sources_, held_},
              std::move(to_grpc),
              [this](const Connection& connection, const std::optional<Closing>& why) { ended(connection, why); }},
      timer_(strand) {
  if (network) tls_.emplace(*network);
}

Peer Front::peer_of(int connection, server::Acceptor::Origin origin) {
  Peer peer{.who = {}, .source = server::connection_owner(connection)};
  if (origin == server::Acceptor::Origin::network) {
    peer.who = "a caller over the network without a certificate";
    peer.needs_token = true;
  } else if (const auto user = server::peer_uid(connection)) {
    std::string& name = users_[*user];
    if (name.empty()) name = server::caller_name(*user);
    peer.who = name;
  } else {
    peer.who = server::anonymous_caller(server::peer_address(connection));
  }
  return peer;
}

void Front::enter(Descriptor connection, server::Acceptor::Service service, server::Acceptor::Origin origin) {
  Peer peer = peer_of(connection.get(), origin);
  const TimePoint now = monotonic_now();
  const auto source = sources_.of(peer.source, now);
  const bool from_network = origin == server::Acceptor::Origin::network;
  // Each handshake costs a signature, the most expensive computation that a source can cause.
  if (from_network && !source->handshakes.take_if_there(1, now)) {
    return on_closing_(peer, {Cause::over_budget, "more TLS handshakes a second than the daemon makes for one source"});
  }
  // A source that connects too often can still stop.
  const bool too_many = !source->connections.take_if_there(1, now);
  const bool stops_only = service == server::Acceptor::Service::stop_only || too_many;
  const auto made = std::make_shared<Connection>(around_, std::move(peer), stops_only);
  connections_.emplace(made.get(), made);
  check_later();
  Socket socket = socket_of(around_.strand, std::move(connection));
  if (from_network) return begin_tls(made, std::move(socket));
  made->start(plain_wire(std::move(socket)));
}

void Front::begin_tls(const std::shared_ptr<Connection>& connection, Socket socket) {
  auto wire = tls_->begin(std::move(socket), [connection](const Wire::Error& error, std::optional<std::string> name) {
    if (error) {
      return connection->close(Closing{Cause::handshake_failed, "the TLS handshake failed: " + error.message()});
    }
    connection->handshake_over(std::move(name));
  });
  if (!wire) return ended(*connection, {});
  connection->hold(std::move(wire));
}

void Front::ended(const Connection& connection, const std::optional<Closing>& why) {
  if (why) on_closing_(connection.peer(), *why);
  connections_.erase(&connection);
  look_whether_grpc_has_left();
}

void Front::announce_end() {
  for (const auto& [address, connection] : Held(connections_)) connection->announce_end();
}

void Front::when_grpc_has_left(std::function<void()> then) {
  when_grpc_has_left_ = std::move(then);
  look_whether_grpc_has_left();
}

void Front::look_whether_grpc_has_left() {
  const auto uses_grpc = [](const auto& held) { return held.second->uses_grpc(); };
  if (!when_grpc_has_left_ || std::ranges::any_of(connections_, uses_grpc)) return;
  std::exchange(when_grpc_has_left_, nullptr)();
}

void Front::check_later() {
  if (std::exchange(timer_runs_, true)) return;
  timer_.expires_after(server::kConnectionsCheck);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) check();
  });
}

void Front::check() {
  timer_runs_ = false;
  const TimePoint now = monotonic_now();
  std::vector<std::shared_ptr<Connection>> held;
  for (const auto& [address, connection] : connections_) held.push_back(connection);
  for (const auto& connection : held) connection->check(now);
  held.clear();
  sources_.forget_idle(now);
  if (!connections_.empty() || sources_.size() > 0) check_later();
}

}  // namespace axisgate::front
