// Orders of the keeper of leases: stops for callers who lost the right to axes, and settings to restore.
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/session/stops.h"
#include "device/use/permission.h"

namespace axisgate::shrc203 {

class LeaseOrders {
 public:
  LeaseOrders(Permission& permission, Stops& stops, Restorer& restorer, const Tasks& tasks)
      : permission_(permission), stops_(stops), restorer_(restorer), tasks_(tasks) {}

  // Advances the keeper to the present time, and carries out its orders.
  void carry_out();

 private:
  Permission& permission_;
  Stops& stops_;
  Restorer& restorer_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
