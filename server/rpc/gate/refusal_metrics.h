// Counts of refused calls and of closed connections for the metrics page, by reason.
#pragma once

#include <prometheus/counter.h>
#include <prometheus/registry.h>

#include <array>

#include "device/core/problem.h"
#include "server/front/closing.h"

namespace axisgate::rpc {

// Reasons that count as a refusal: the caller is unknown, lacks the right or has too much open, or another caller has
// the axes.
inline constexpr std::array kRefusals = {Reason::unauthenticated, Reason::not_allowed, Reason::queue_full,
                                         Reason::lease_held,      Reason::lease_lost,  Reason::outside_lease};

// Every series exists from the start. Thread safe. The registry must outlive this object.
class RefusalMetrics {
 public:
  explicit RefusalMetrics(prometheus::Registry& registry);

  // Counts one of kRefusals. Returns false for another reason, which is not counted.
  bool count(Reason reason);
  void count(front::Cause cause);

 private:
  std::array<prometheus::Counter*, kRefusals.size()> refusals_{};       // in the order of kRefusals
  std::array<prometheus::Counter*, front::kCauses.size()> closings_{};  // by Cause
};

}  // namespace axisgate::rpc
