// Tokens between messages of the API and plain values.
#pragma once

#include <vector>

#include "axisgate/v1/access.pb.h"
#include "device/core/problem.h"
#include "server/access/tokens.h"
#include "server/api/sharing/tokens.h"

namespace axisgate::proto {

v1::Token to_proto(const server::Token& token);
// Fills the page that `request` asks for from all tokens, oldest first.
void fill_page(const v1::ListTokensRequest& request, std::vector<server::Token> tokens,
               v1::ListTokensResponse& response);

// Fails with invalid_request.
Result<api::NewToken> to_new_token(const v1::CreateTokenRequest& request);

}  // namespace axisgate::proto
