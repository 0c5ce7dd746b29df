// Counts and logs refused calls and connections closed for a reason.
#pragma once

#include <grpcpp/support/server_interceptor.h>
#include <prometheus/registry.h>

#include <memory>
#include <string_view>
#include <utility>

#include "device/core/problem.h"
#include "server/api/request/call.h"
#include "server/events/refusal_log.h"
#include "server/front/call_filter.h"
#include "server/front/closing.h"
#include "server/rpc/gate/refusal_metrics.h"

namespace axisgate::rpc {

// A log line never contains tokens or other credentials. Thread safe.
class Refusals {
 public:
  // `registry` must outlive this object.
  Refusals(prometheus::Registry& registry, server::RefusalLog::Later later)
      : metrics_(registry), log_(std::move(later)) {}

  // Notes a call that ended with a problem, if `reason` is one of kRefusals. `message` may contain the client's own
  // text.
  void note(const front::Peer& peer, const api::Credential& credential, std::string_view method, Reason reason,
            std::string_view message);
  void note(const front::Peer& peer, const front::Closing& closing);

  // Returns an interceptor for a grpc::ServerBuilder that notes the calls that gRPC ends. This object must outlive the
  // server.
  std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> interceptor();

 private:
  RefusalMetrics metrics_;
  server::RefusalLog log_;
};

}  // namespace axisgate::rpc
