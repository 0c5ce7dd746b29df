#include "device/shrc203/session/runaways.h"

#include "device/core/guard.h"

namespace axisgate::shrc203 {

void Runaways::stop() {
  if (axes_.empty() || !guarded(Guard::runaways_stopped)) return;
  stops_.stop(axes_, {.who = "the gateway: a jog ran on while the line was lost"});
}

}  // namespace axisgate::shrc203
