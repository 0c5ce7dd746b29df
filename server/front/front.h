// The part of the server before gRPC: takes every connection, ends TLS, keeps each source within its budget, lets calls
// in or refuses them, and answers stops itself.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "device/link/asio.h"
#include "device/link/descriptor.h"
#include "server/config/config.h"
#include "server/connections/acceptor.h"
#include "server/front/budget.h"
#include "server/front/call_filter.h"
#include "server/front/closing.h"
#include "server/front/connection.h"
#include "server/front/holding.h"
#include "server/front/limits.h"
#include "server/front/tls.h"

namespace axisgate::front {

// Runs on one strand, on which nothing may run when the Front is destroyed.
class Front {
 public:
  // Called on the strand when this side has closed a connection for a cause.
  using OnClosing = std::function<void(const Peer&, const Closing&)>;

  // `filter` must outlive this object. `to_grpc` receives a connected socket for each client that has a call for gRPC.
  Front(Strand strand, CallFilter& filter, const std::optional<server::NetworkConfig>& network,
        std::function<void(Descriptor)> to_grpc, OnClosing on_closing, const FrontLimits& limits = {});

  ~Front() { around_.inbox->close(); }

  void enter(Descriptor connection, server::Acceptor::Service service, server::Acceptor::Origin origin);

  // Announces the end of the daemon to all clients: Conversation::announce_end().
  void announce_end();
  // Calls `then` on the strand once gRPC has closed all of its connections and its last answers were sent to the
  // clients.
  void when_grpc_has_left(std::function<void()> then);

 private:
  using Held = std::map<const Connection*, std::shared_ptr<Connection>>;

  Peer peer_of(int connection, server::Acceptor::Origin origin);
  void begin_tls(const std::shared_ptr<Connection>& connection, Socket socket);
  void ended(const Connection& connection, const std::optional<Closing>& why);
  void look_whether_grpc_has_left();
  void check_later();
  void check();

  const FrontLimits limits_;
  Sources sources_;
  HeldBytes held_;
  const OnClosing on_closing_;
  std::optional<TlsFiles> tls_;
  std::map<uid_t, std::string> users_;  // names of the users, each looked up once
  Connection::Surroundings around_;
  Held connections_;
  std::function<void()> when_grpc_has_left_;  // empty: no caller waits
  boost::asio::steady_timer timer_;
  bool timer_runs_ = false;
};

}  // namespace axisgate::front
