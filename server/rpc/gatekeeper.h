// Lets a call in, or refuses it before any handler sees it.
#pragma once

#include <grpcpp/security/auth_metadata_processor.h>
#include <grpcpp/server_context.h>

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "server/api/admission.h"
#include "server/api/call.h"
#include "server/rpc/rpc_metrics.h"

namespace axisgate::rpc {

// Callers whom nothing names. They have their limits together, since nothing distinguishes them for certain.
inline constexpr const char* kAnonymous = "a caller over TCP";

// What all gatekeepers ask, and where they report.
struct Gate {
  const api::Admission& admission;
  RpcMetrics& metrics;
};

// Of one endpoint, which calls of one kind come in by. Refusals by a gatekeeper have a message but no details: gRPC
// 1.51 sends none from there.
class Gatekeeper final : public grpc::AuthMetadataProcessor {
 public:
  // Whom the connection itself names: "unix alice", "cert alice"; none: nobody.
  using Name = std::function<std::optional<std::string>(const grpc::AuthContext& connection)>;

  // `unnamed` is who comes in here where `name` names nobody. What `gate` names outlives this.
  Gatekeeper(const Gate& gate, Name name, api::Credential unnamed)
      : gate_(gate), name_(std::move(name)), unnamed_(std::move(unnamed)) {}

  // It waits for nothing, and so needs no thread of gRPC's pool.
  bool IsBlocking() const override { return false; }

  grpc::Status Process(const InputMetadata& metadata, grpc::AuthContext* connection, OutputMetadata* consumed,
                       OutputMetadata* response) override;

 private:
  grpc::Status judge(const InputMetadata& metadata, grpc::AuthContext& connection);
  api::Credential without_token(grpc::AuthContext& connection);

  const Gate gate_;
  const Name name_;
  const api::Credential unnamed_;
  std::mutex mutex_;
};

// Of a call that was let in: its token, and its user on the Unix socket, its certificate, or where it comes from.
api::Credential credential_of(const grpc::CallbackServerContext& call);

// By whose limits a call counts that was let in: its caller's name, or kAnonymous.
std::string identity(const grpc::ServerContextBase& call);

}  // namespace axisgate::rpc
