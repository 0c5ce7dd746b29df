// Who calls, and tokens.
#pragma once

#include <grpcpp/server_context.h>

#include "axisgate/v1/access.grpc.pb.h"
#include "server/access/access.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class AccessService final : public api::AccessService::CallbackService {
 public:
  // It outlives this.
  explicit AccessService(server::Access& access) : access_(access) {}

  grpc::ServerUnaryReactor* GetCaller(grpc::CallbackServerContext* context, const api::GetCallerRequest* request,
                                      api::GetCallerResponse* response) override;
  grpc::ServerUnaryReactor* CreateToken(grpc::CallbackServerContext* context, const api::CreateTokenRequest* request,
                                        api::CreateTokenResponse* response) override;
  grpc::ServerUnaryReactor* ListTokens(grpc::CallbackServerContext* context, const api::ListTokensRequest* request,
                                       api::ListTokensResponse* response) override;
  grpc::ServerUnaryReactor* RevokeToken(grpc::CallbackServerContext* context, const api::RevokeTokenRequest* request,
                                        api::RevokeTokenResponse* response) override;

 private:
  server::Access& access_;
};

}  // namespace axisgate::rpc
