// Distinction between a client that has sent everything and a client whose connection broke off.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "server/gateway.h"
#include "server/limits.h"

namespace axisgate::rpc {

// gRPC ends the reading in the same way in both cases. It cancels only the call of a client that broke off, and only
// after the end of the reading.
class HalfClose {
 public:
  // `gateway` must outlive this object.
  explicit HalfClose(server::Gateway& gateway) : gateway_(gateway) {}

  // Calls `then` on the readers' thread after server::kBreakOffWait. By then, gRPC has cancelled the call of a client
  // that broke off.
  void wait(std::function<void()> then) const { gateway_.timeouts().after(server::kBreakOffWait, std::move(then)); }

 private:
  server::Gateway& gateway_;
};

}  // namespace axisgate::rpc
