#include "device/shrc203/session/lease_orders.h"

namespace axisgate::shrc203 {

void LeaseOrders::carry_out() {
  const Orders orders = permission_.advance(tasks_.now());
  for (const StopOrder& order : orders.stops) {
    const RequestContext gateway{.who = "the gateway on behalf of " + order.who};
    stops_.stop(AxisSet::in(order.scope), StopKind::stop, gateway,
                [this, id = order.id](const StopReport&) { permission_.stopped(id, tasks_.now()); });
  }
  for (const EndedLease& lease : orders.restoring) restorer_.lease_ended(lease);
}

}  // namespace axisgate::shrc203
