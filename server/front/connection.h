// The I/O of one client's connection: its bytes through a Conversation, and to gRPC if a call is gRPC's.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/link/asio.h"
#include "device/link/clock.h"
#include "device/link/descriptor.h"
#include "device/link/inbox.h"
#include "server/front/conversation.h"
#include "server/front/wire.h"

namespace axisgate::front {

// Used on the front's strand. A Connection lives as long as one of its operations is pending or the front keeps it.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  // Parts of the front that a connection uses.
  struct Surroundings {
    Strand strand;
    std::shared_ptr<Inbox> inbox;  // leads to that strand
    Conversation::Shared shared;
    std::function<void(Descriptor)> to_grpc;  // receives a separate non-blocking connection for gRPC
    // Called once when the connection is closed, with the reason if this side closed it for a cause.
    std::function<void(const Connection&, const std::optional<Closing>&)> ended;
  };

  // `around` must outlive this object.
  Connection(const Surroundings& around, Peer peer, bool stops_only);

  void start(std::unique_ptr<Wire> wire);
  // Keeps a wire whose handshake is still to come.
  void hold(std::unique_ptr<Wire> wire) { wire_ = std::move(wire); }
  void handshake_over(std::optional<std::string> certificate);

  // Announces the end of the daemon like Conversation::announce_end().
  void announce_end();
  // Called periodically; ends operations that have taken too long.
  void check(TimePoint now);
  void close(const std::optional<Closing>& why = {});

  bool uses_grpc() const { return grpc_.is_open(); }
  const Peer& peer() const { return peer_; }

 private:
  using Error = Wire::Error;

  void begin();
  void pull(StreamId stream);
  void move_on();
  void read_client();
  void feed_later();
  void feed();
  void write_client();
  void connect_to_grpc();
  void read_grpc();
  void take_from_grpc();
  void write_grpc();
  void wait_for_budget(TimePoint now);

  const Surroundings& around_;
  Peer peer_;
  const bool stops_only_;
  const TimePoint begun_ = monotonic_now();
  TimePoint active_ = begun_;
  std::optional<TimePoint> over_since_;
  std::unique_ptr<Wire> wire_;
  std::optional<Conversation> conversation_;  // none during a handshake
  boost::asio::local::stream_protocol::socket grpc_;
  boost::asio::steady_timer budget_timer_;
  std::string from_client_;
  std::string_view unfed_;           // part of from_client_
  std::string to_client_, to_grpc_;  // being written
  // Pending operations of each kind.
  bool reads_client_ = false, writes_client_ = false, reads_grpc_ = false, writes_grpc_ = false;
  bool grpc_left_ = false;
  bool closed_ = false;
};

}  // namespace axisgate::front
