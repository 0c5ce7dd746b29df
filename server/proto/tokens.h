// Tokens between messages of the API and plain values.
#pragma once

#include "axisgate/v1/access.pb.h"
#include "device/core/problem.h"
#include "server/access/tokens.h"
#include "server/api/sharing/tokens.h"

namespace axisgate::proto {

v1::Token to_proto(const server::Token& token);

// Fails with invalid_request.
Result<api::NewToken> to_new_token(const v1::CreateTokenRequest& request);

}  // namespace axisgate::proto
