#include "server/doors/doors.h"

#include <chrono>
#include <future>
#include <utility>

#include "device/link/asio.h"
#include "server/limits.h"

namespace axisgate::server {
Result<std::unique_ptr<Doors>> Doors::open(Gateway& gateway, Access& access, SavedPositions& positions,
                                           const ConnectionLimits& limits) {
  const Config& config = gateway.config();
  const auto network = config.network ? std::optional(config.network->listen) : std::nullopt;
  auto listener = Listener::open(config.listen, config.socket, network);
  if (!listener) return tl::unexpected(listener.error());
  std::unique_ptr<Doors> doors(new Doors(gateway, access, positions, *std::move(listener)));
  if (const auto serving = doors->serve(gateway, limits); !serving) return tl::unexpected(serving.error());
  return doors;
}

Doors::Doors(Gateway& gateway, Access& access, SavedPositions& positions, std::unique_ptr<Listener> listener)
    : api_(gateway, access, positions),
      listener_(std::move(listener)),
      grpc_(gateway, api_),
      front_(
          listener_->strand(), grpc_.filter(), gateway.config().network,
          [this](Descriptor connection) {
            // gRPC would not close a connection that it receives while it ends.
            if (!ending_) grpc_.enter(std::move(connection));
          },
          [this](const front::Peer& peer, const front::Closing& closing) { grpc_.note(peer, closing); },
          {.message_bytes = static_cast<std::size_t>(gateway.config().limits.message_bytes)}) {}

Result<void> Doors::serve(Gateway& gateway, const ConnectionLimits& limits) {
  if (const auto started = grpc_.start(); !started) return started;
  listener_->start(limits, [this](Descriptor connection, Acceptor::Service service, Acceptor::Origin origin) {
    front_.enter(std::move(connection), service, origin);
  });
  connection_metrics_.emplace(gateway.metrics(), [this] { return listener_->counts(); });
  return {};
}

std::vector<Watchdog::Thread> Doors::threads() {
  const auto ask_listener = [strand = listener_->strand()](std::function<void()> answer) {
    boost::asio::post(strand, std::move(answer));
  };
  return {{"the thread of the listener", ask_listener}, grpc_.thread()};
}

Doors::~Doors() {
  connection_metrics_.reset();
  ending_ = true;
  listener_->stop_accepting();
  on_the_front([this](const std::function<void()>& done) {
    front_.announce_end();
    done();
  });
  api_.streams.end_all();
  grpc_.end();
  // The ends of streams may still be in the front's buffers.
  on_the_front([this](const std::function<void()>& done) { front_.when_grpc_has_left(done); });
  listener_->stop();
}

// Runs `act` on the front's strand and waits until `act` has called `done`, at most kFrontEnd.
void Doors::on_the_front(std::function<void(const std::function<void()>& done)> act) {
  const auto acted = std::make_shared<std::promise<void>>();
  boost::asio::post(listener_->strand(), [acted, act = std::move(act)] { act([acted] { acted->set_value(); }); });
  acted->get_future().wait_for(kFrontEnd);
}

}  // namespace axisgate::server
