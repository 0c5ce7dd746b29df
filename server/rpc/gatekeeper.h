// Lets a call in, or refuses it before any handler sees it.
#pragma once

#include <grpcpp/security/auth_metadata_processor.h>
#include <grpcpp/server_context.h>

#include <mutex>
#include <optional>
#include <string>

#include "server/access/access.h"

namespace axisgate::rpc {

// Of one entrance. Refusals by a gatekeeper have a message but no details: gRPC 1.51 sends none from there.
class Gatekeeper final : public grpc::AuthMetadataProcessor {
 public:
  // `user` names those who come in here without a token; null: nobody knows them. Both outlive this.
  Gatekeeper(const server::Access& access, const std::string* user) : access_(access), user_(user) {}

  // It waits for nothing, and so needs no thread of gRPC's pool.
  bool IsBlocking() const override { return false; }

  grpc::Status Process(const InputMetadata& metadata, grpc::AuthContext* connection, OutputMetadata* consumed,
                       OutputMetadata* response) override;

 private:
  const server::Access& access_;
  const std::string* const user_;
  std::mutex mutex_;
};

// As whom a call that was let in is known: by its token, its user on the Unix socket, or where it comes from.
std::string caller(const grpc::CallbackServerContext& call);

// With the role; of a call that was let in. unauthenticated, where its token was revoked since.
Result<server::Caller> caller_with_role(const grpc::CallbackServerContext& call, const server::Access& access);

}  // namespace axisgate::rpc
