#include "device/shrc203/session/orphaned_jogs.h"

#include "device/core/guard.h"

namespace axisgate::shrc203 {

void OrphanedJogs::stop() {
  if (axes_.empty() || !guarded(Guard::orphaned_jogs_stopped)) return;
  stops_.stop(axes_, {.who = "the gateway: a jog ran on while the line was lost"});
}

}  // namespace axisgate::shrc203
