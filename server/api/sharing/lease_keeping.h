// Lease that is kept alive over a stream.
#pragma once

#include <optional>
#include <string_view>

#include "server/access/leases.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"

namespace axisgate::api {

// A LeaseKeeping receives a message once the message before was answered. Its reader receives the lease after each
// message. Thread safe.
class LeaseKeeping final : public Subscription<server::Lease> {
 public:
  // `gateway` must outlive this object.
  LeaseKeeping(const server::Gateway& gateway, Streams::Place place)
      : Subscription(std::move(place)), gateway_(gateway) {}

  // Extends the lease by another time_to_live. Ends the stream with invalid_request, unknown_device or lease_lost if
  // that fails.
  void keep(std::string_view device, std::string_view lease_token);
  // Handles an invalid message: ends the stream with `problem`. The lease then lasts as its terms say.
  void refuse(const Problem& problem);
  // Ends the stream at the caller's request. The lease is no longer kept alive, but does not count as lost.
  void finish();
  // Handles a caller who disconnected without ending the stream: the lease's terms decide what follows.
  void break_off() override;

 private:
  void keep_on(server::Device& device, server::LeaseToken token, TimePoint now);
  void end(StreamEnd end);
  void begin() override {}
  Reading read() override;

  const server::Gateway& gateway_;

  // Under mutex_.
  std::optional<server::Lease> due_;
  std::optional<StreamEnd> end_;       // delivered after due_
  server::Device* kept_on_ = nullptr;  // null: no lease was kept alive yet
  server::LeaseToken kept_ = 0;
};

}  // namespace axisgate::api
