// AccessService: the caller's own name and role, and tokens.
#include <vector>

#include "axisgate/v1/access.grpc.pb.h"
#include "server/api/sharing/tokens.h"
#include "server/proto/callers.h"
#include "server/proto/pages.h"
#include "server/proto/tokens.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

class AccessService final : public v1::AccessService::CallbackService {
 public:
  // `tokens` must outlive this object.
  explicit AccessService(const api::Tokens& tokens) : tokens_(tokens) {}

  grpc::ServerUnaryReactor* GetCaller(grpc::CallbackServerContext* context, const v1::GetCallerRequest*,
                                      v1::GetCallerResponse* response) override {
    return answer_at_once(response, tokens_.caller(to_call(*context)),
                          [](v1::GetCallerResponse& answer, const server::Caller& caller) {
                            *answer.mutable_caller() = proto::to_caller(caller.who);
                            answer.set_role(static_cast<v1::Role>(caller.role));
                          });
  }

  grpc::ServerUnaryReactor* CreateToken(grpc::CallbackServerContext* context, const v1::CreateTokenRequest* request,
                                        v1::CreateTokenResponse* response) override {
    return answer_at_once(response, tokens_.create(to_checked_call(*context, *request), proto::to_new_token(*request)),
                          [](v1::CreateTokenResponse& answer, const std::optional<api::CreatedToken>& created) {
                            if (!created) return;
                            answer.set_secret(created->secret);
                            *answer.mutable_token() = proto::to_proto(created->token);
                          });
  }

  grpc::ServerUnaryReactor* ListTokens(grpc::CallbackServerContext* context, const v1::ListTokensRequest* request,
                                       v1::ListTokensResponse* response) override {
    if (const auto good = proto::check_page(request->page_size(), request->page_token()); !good) {
      return UnaryCall<v1::ListTokensResponse>::start(response)->refuse(good.error());
    }
    return answer_at_once(response, tokens_.list(to_call(*context)),
                          [&](v1::ListTokensResponse& answer, std::vector<server::Token> tokens) {
                            proto::fill_page(*request, std::move(tokens), answer);
                          });
  }

  grpc::ServerUnaryReactor* RevokeToken(grpc::CallbackServerContext* context, const v1::RevokeTokenRequest* request,
                                        v1::RevokeTokenResponse* response) override {
    const auto call = UnaryCall<v1::RevokeTokenResponse>::start(response);
    answering(call)(tokens_.revoke(to_call(*context), request->token()));
    return call.get();
  }

 private:
  const api::Tokens& tokens_;
};

}  // namespace

std::unique_ptr<grpc::Service> access_service(const ServiceParts& parts) {
  return std::make_unique<AccessService>(parts.api.tokens);
}

}  // namespace axisgate::rpc
