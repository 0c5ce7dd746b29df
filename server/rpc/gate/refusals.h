// What is refused and what is closed for a cause, on record: counted, and in the log.
#pragma once

#include <grpcpp/support/server_interceptor.h>
#include <prometheus/registry.h>

#include <memory>
#include <string_view>
#include <utility>

#include "device/core/problem.h"
#include "server/api/request/call.h"
#include "server/events/refusal_log.h"
#include "server/front/closing.h"
#include "server/front/desk.h"
#include "server/rpc/gate/refusal_metrics.h"

namespace axisgate::rpc {

// Nothing that identifies a caller to the daemon, no token of any kind, stands in a line. Thread safe.
class Refusals {
 public:
  // `registry` outlives it.
  Refusals(prometheus::Registry& registry, server::RefusalLog::Later later)
      : metrics_(registry), log_(std::move(later)) {}

  // A call of a peer that ended with a problem; one whose reason is none of kRefusals is not noted. Texts may
  // be a client's own.
  void note(const front::Peer& peer, const api::Credential& credential, std::string_view method, Reason reason,
            std::string_view message);
  void note(const front::Peer& peer, const front::Closing& closing);

  // For a grpc::ServerBuilder: notes the calls that gRPC ends. This outlives the server that it builds.
  std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> interceptor();

 private:
  RefusalMetrics metrics_;
  server::RefusalLog log_;
};

}  // namespace axisgate::rpc
