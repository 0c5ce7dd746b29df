// Lets a call in, or refuses it before any handler sees it.
#pragma once

#include <grpcpp/security/auth_metadata_processor.h>
#include <grpcpp/server_context.h>

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "server/access/access.h"
#include "server/rpc/call_limits.h"
#include "server/rpc/rpc_metrics.h"

namespace axisgate::rpc {

// Who comes in nameless. They have their limits together, since nothing tells them apart for certain.
inline constexpr const char* kNameless = "a caller over TCP";

// What all gatekeepers ask, and where they report.
struct Gate {
  const server::Access& access;
  const CallLimits& limits;
  RpcMetrics& metrics;
};

// Of one entrance, which calls of one kind come in by. Refusals by a gatekeeper have a message but no details:
// gRPC 1.51 sends none from there.
class Gatekeeper final : public grpc::AuthMetadataProcessor {
 public:
  // Whom the connection itself tells of: "unix alice", "cert alice"; none: nobody knows.
  using Name = std::function<std::optional<std::string>(const grpc::AuthContext& connection)>;

  // `unnamed` is who comes in here without a token where `name` knows nobody. What `gate` names outlives this.
  Gatekeeper(const Gate& gate, Name name, server::Caller unnamed)
      : gate_(gate), name_(std::move(name)), unnamed_(std::move(unnamed)) {}

  // It waits for nothing, and so needs no thread of gRPC's pool.
  bool IsBlocking() const override { return false; }

  grpc::Status Process(const InputMetadata& metadata, grpc::AuthContext* connection, OutputMetadata* consumed,
                       OutputMetadata* response) override;

 private:
  grpc::Status judge(const InputMetadata& metadata, grpc::AuthContext& connection);
  server::Caller without_token(grpc::AuthContext& connection);

  const Gate gate_;
  const Name name_;
  const server::Caller unnamed_;
  std::mutex mutex_;
};

// As whom a call that was let in is known: by its token, its user on the Unix socket, its certificate, or where it
// comes from.
std::string caller(const grpc::CallbackServerContext& call);

// By whose limits a call counts that was let in: as caller(), or kNameless.
std::string identity(const grpc::ServerContextBase& call);

// Of a call that was let in: "operator". unauthenticated, where its token was revoked since.
Result<std::string> role_of(const grpc::CallbackServerContext& call, const server::Access& access);

// With the role; of a call that was let in. unauthenticated, where its token was revoked since.
Result<server::Caller> caller_with_role(const grpc::CallbackServerContext& call, const server::Access& access);
// not_allowed where the line is one that the configuration keeps for administrators.
Result<void> check_command_role(const std::string& line, const server::Caller& caller, const server::Access& access);

}  // namespace axisgate::rpc
