// A lease that is kept alive over a stream.
#pragma once

#include <optional>
#include <string_view>

#include "server/access/leases.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"

namespace axisgate::api {

// One message is taken in when the one before has been answered. Its reader receives the lease as it is after each.
// Thread safe.
class LeaseKeeping final : public Subscription<server::Lease> {
 public:
  // `gateway` outlives this.
  LeaseKeeping(const server::Gateway& gateway, Streams::Place place)
      : Subscription(std::move(place)), gateway_(gateway) {}

  // The lease lives on for another time_to_live. The stream ends with invalid_request, unknown_device or lease_lost.
  void keep(std::string_view device, std::string_view lease_token);
  // What came is no message of this stream, which ends with `problem`. The lease then lives on as its terms have it.
  void refuse(const Problem& problem);
  // The caller has ended the stream in order: nothing is kept alive any more, and nothing was lost.
  void finish();
  // The caller has gone without a word: what follows is as the lease's terms have it.
  void break_off() override;

 private:
  void keep_on(server::Device& device, server::LeaseToken token, TimePoint now);
  void end(StreamEnd end);
  void begin() override {}
  Reading read() override;

  const server::Gateway& gateway_;

  // Under mutex_.
  std::optional<server::Lease> due_;
  std::optional<StreamEnd> end_;       // after what is due
  server::Device* kept_on_ = nullptr;  // null: nothing has been kept alive yet
  server::LeaseToken kept_ = 0;
};

}  // namespace axisgate::api
