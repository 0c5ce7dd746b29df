// Saved positions as callers write and read them.
#pragma once

#include "axisgate/v1/position.pb.h"
#include "device/core/problem.h"
#include "server/api/stage/positions.h"

namespace axisgate::proto {

// invalid_request.
Result<api::PositionWish> to_wish(const v1::SavePositionRequest& request);

v1::Position to_proto(const api::NamedPosition& position);

}  // namespace axisgate::proto
