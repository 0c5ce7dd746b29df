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

namespace axisgate::rpc {

// Of one entrance, which calls of one kind come in by. Refusals by a gatekeeper have a message but no details:
// gRPC 1.51 sends none from there.
class Gatekeeper final : public grpc::AuthMetadataProcessor {
 public:
  // Whom the connection itself tells of: "unix alice", "cert alice"; none: nobody knows.
  using Name = std::function<std::optional<std::string>(const grpc::AuthContext& connection)>;

  // `unnamed` is who comes in here without a token where `name` knows nobody. `access` outlives this.
  Gatekeeper(const server::Access& access, Name name, server::Caller unnamed)
      : access_(access), name_(std::move(name)), unnamed_(std::move(unnamed)) {}

  // It waits for nothing, and so needs no thread of gRPC's pool.
  bool IsBlocking() const override { return false; }

  grpc::Status Process(const InputMetadata& metadata, grpc::AuthContext* connection, OutputMetadata* consumed,
                       OutputMetadata* response) override;

 private:
  server::Caller without_token(grpc::AuthContext& connection);

  const server::Access& access_;
  const Name name_;
  const server::Caller unnamed_;
  std::mutex mutex_;
};

// As whom a call that was let in is known: by its token, its user on the Unix socket, its certificate, or where it
// comes from.
std::string caller(const grpc::CallbackServerContext& call);

// With the role; of a call that was let in. unauthenticated, where its token was revoked since.
Result<server::Caller> caller_with_role(const grpc::CallbackServerContext& call, const server::Access& access);

}  // namespace axisgate::rpc
