// Why a call that comes while the daemon ends is not served.
#pragma once

#include "device/core/problem.h"

namespace axisgate::api {

// daemon_ending: nothing was done.
inline Problem daemon_ending() {
  return {
      .reason = Reason::daemon_ending, .message = "the daemon is ending", .hint = "connect again when it runs again"};
}

}  // namespace axisgate::api
