// Whether a client that sends no more has sent all, or has broken off.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "server/gateway.h"

namespace axisgate::rpc {

// gRPC ends the reading alike for a client that has sent all and for one that broke off; only the second is then
// cancelled, at once but after.
class HalfClose {
 public:
  // It outlives this.
  explicit HalfClose(server::Gateway& gateway) : gateway_(gateway) {}

  // Calls `then` on the readers' thread when a client that broke off would have been cancelled.
  void wait(std::function<void()> then) const { gateway_.timeouts().after(kBreakOffWait, std::move(then)); }

 private:
  static constexpr Duration kBreakOffWait = std::chrono::milliseconds(10);

  server::Gateway& gateway_;
};

}  // namespace axisgate::rpc
