#include "server/rpc/gate/refusal_metrics.h"

#include <prometheus/family.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace axisgate::rpc {

RefusalMetrics::RefusalMetrics(prometheus::Registry& registry) {
  auto& refusals = prometheus::BuildCounter()
                       .Name("axisgate_refusals_total")
                       .Help("Calls that were refused for who called, what the caller may do or has open, or a lease.")
                       .Register(registry);
  auto& closings = prometheus::BuildCounter()
                       .Name("axisgate_connections_closed_total")
                       .Help("Connections that the daemon closed for a cause.")
                       .Register(registry);
  for (std::size_t i = 0; i < kRefusals.size(); ++i) {
    refusals_[i] = &refusals.Add({{"reason", std::string(name(kRefusals[i]))}});
  }
  for (const front::Cause cause : front::kCauses) {
    closings_.at(static_cast<std::size_t>(cause)) = &closings.Add({{"why", std::string(front::name(cause))}});
  }
}

bool RefusalMetrics::count(Reason reason) {
  const auto found = std::ranges::find(kRefusals, reason);
  if (found == kRefusals.end()) return false;
  refusals_[static_cast<std::size_t>(found - kRefusals.begin())]->Increment();
  return true;
}

void RefusalMetrics::count(front::Cause cause) { closings_.at(static_cast<std::size_t>(cause))->Increment(); }

}  // namespace axisgate::rpc
