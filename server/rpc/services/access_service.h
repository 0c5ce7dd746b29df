// AccessService: the caller's own name and role, and tokens.
#pragma once

#include "axisgate/v1/access.grpc.pb.h"
#include "server/api/sharing/tokens.h"

namespace axisgate::rpc {

class AccessService final : public v1::AccessService::CallbackService {
 public:
  // `tokens` must outlive this object.
  explicit AccessService(const api::Tokens& tokens) : tokens_(tokens) {}

  grpc::ServerUnaryReactor* GetCaller(grpc::CallbackServerContext* context, const v1::GetCallerRequest* request,
                                      v1::GetCallerResponse* response) override;
  grpc::ServerUnaryReactor* CreateToken(grpc::CallbackServerContext* context, const v1::CreateTokenRequest* request,
                                        v1::CreateTokenResponse* response) override;
  grpc::ServerUnaryReactor* ListTokens(grpc::CallbackServerContext* context, const v1::ListTokensRequest* request,
                                       v1::ListTokensResponse* response) override;
  grpc::ServerUnaryReactor* RevokeToken(grpc::CallbackServerContext* context, const v1::RevokeTokenRequest* request,
                                        v1::RevokeTokenResponse* response) override;

 private:
  const api::Tokens& tokens_;
};

}  // namespace axisgate::rpc
