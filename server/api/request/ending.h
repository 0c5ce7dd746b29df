// Refusal of calls that arrive while the daemon ends.
#pragma once

#include "device/core/problem.h"

namespace axisgate::api {

// Returns the problem daemon_ending. The call has not had any effect.
inline Problem daemon_ending() {
  return {
      .reason = Reason::daemon_ending, .message = "the daemon is ending", .hint = "connect again when it runs again"};
}

}  // namespace axisgate::api
