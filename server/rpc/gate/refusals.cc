#include "server/rpc/gate/refusals.h"

#include <fmt/format.h>
#include <google/rpc/status.pb.h>

#include <optional>
#include <string>

#include "axisgate/v1/common.pb.h"
#include "device/core/escape.h"
#include "server/rpc/calls/call.h"

namespace axisgate::rpc {
namespace {

namespace record = grpc::experimental;

constexpr std::size_t kMessageMax = 300;

// Returns the problem that to_status() has packed. nullopt if there is none.
std::optional<v1::Problem> problem_of(const grpc::Status& status) {
  google::rpc::Status details;
  v1::Problem problem;
  if (status.error_details().empty() || !details.ParseFromString(status.error_details())) return std::nullopt;
  if (details.details_size() == 0 || !problem.ParseFromString(details.details(0).value())) return std::nullopt;
  return problem;
}

// Leaves out the name in a wrong token: it could be a piece of a valid token.
std::string shown(const front::Peer& peer, const api::Credential& credential, Reason reason) {
  return reason == Reason::unauthenticated ? peer.who : api::name_of(credential);
}

// A NotingCall is one call that gRPC serves, until its status is sent.
class NotingCall final : public record::Interceptor {
 public:
  NotingCall(Refusals& refusals, record::ServerRpcInfo& call) : refusals_(refusals), call_(call) {}

  void Intercept(record::InterceptorBatchMethods* batch) override {
    if (batch->QueryInterceptionHookPoint(record::InterceptionHookPoints::PRE_SEND_STATUS)) {
      const grpc::Status status = batch->GetSendStatus();
      if (!status.ok()) note(status);
    }
    batch->Proceed();
  }

 private:
  void note(const grpc::Status& status) {
    const auto problem = problem_of(status);
    if (!problem) return;
    const grpc::ServerContextBase& context = *call_.server_context();
    refusals_.note(peer_of(context), credential_of(context), call_.method(), static_cast<Reason>(problem->reason()),
                   problem->message());
  }

  Refusals& refusals_;
  record::ServerRpcInfo& call_;  // gRPC's; lives as long as the call
};

class NotingFactory final : public record::ServerInterceptorFactoryInterface {
 public:
  explicit NotingFactory(Refusals& refusals) : refusals_(refusals) {}

  // gRPC owns the result.
  record::Interceptor* CreateServerInterceptor(record::ServerRpcInfo* call) override {
    return new NotingCall(refusals_, *call);
  }

 private:
  Refusals& refusals_;
};

}  // namespace

void Refusals::note(const front::Peer& peer, const api::Credential& credential, std::string_view method, Reason reason,
                    std::string_view message) {
  if (!metrics_.count(reason)) return;
  log_.note(peer.source,
            fmt::format("refused {} of {} ({}): {}: {}", escaped(method), escaped(shown(peer, credential, reason)),
                        escaped(peer.source), name(reason), escaped(message, kMessageMax)));
}

void Refusals::note(const front::Peer& peer, const front::Closing& closing) {
  metrics_.count(closing.cause);
  log_.note(peer.source, fmt::format("closed a connection of {} ({}): {}", escaped(peer.who), escaped(peer.source),
                                     escaped(closing.text, kMessageMax)));
}

std::unique_ptr<record::ServerInterceptorFactoryInterface> Refusals::interceptor() {
  return std::make_unique<NotingFactory>(*this);
}

}  // namespace axisgate::rpc
