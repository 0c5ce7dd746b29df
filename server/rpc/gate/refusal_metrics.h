// Refused calls and closed connections on the metrics page, by why.
#pragma once

#include <prometheus/counter.h>
#include <prometheus/registry.h>

#include <array>

#include "device/core/problem.h"
#include "server/front/closing.h"

namespace axisgate::rpc {

// What counts as a refusal: the caller is unknown, may not, or has too much open; or another caller has the axes.
inline constexpr std::array kRefusals = {Reason::unauthenticated, Reason::not_allowed, Reason::queue_full,
                                         Reason::lease_held,      Reason::lease_lost,  Reason::outside_lease};

// Every series exists from the start. Thread safe. The registry outlives it.
class RefusalMetrics {
 public:
  explicit RefusalMetrics(prometheus::Registry& registry);

  // One of kRefusals; false for another reason, which is not counted.
  bool count(Reason reason);
  void count(front::Cause cause);

 private:
  std::array<prometheus::Counter*, kRefusals.size()> refusals_{};       // in the order of kRefusals
  std::array<prometheus::Counter*, front::kCauses.size()> closings_{};  // by Cause
};

}  // namespace axisgate::rpc
