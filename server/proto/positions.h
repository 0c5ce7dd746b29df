// Conversion of saved positions from and to callers' messages.
#pragma once

#include "axisgate/v1/position.pb.h"
#include "device/core/problem.h"
#include "server/api/stage/positions.h"
#include "server/proto/shown.h"

namespace axisgate::proto {

// Fails with invalid_request.
Result<api::PositionWish> to_wish(const v1::SavePositionRequest& request);

// `shown` is that of the position's stage.
v1::Position to_proto(const api::NamedPosition& position, const Shown& shown);

}  // namespace axisgate::proto
