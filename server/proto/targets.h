// Moves, path segments and scans as callers write them, as the api takes them.
#pragma once

#include "axisgate/v1/stage.pb.h"
#include "device/core/problem.h"
#include "device/stage/requests.h"
#include "server/api/stage/targets.h"

namespace axisgate::proto {

// unknown_axis, invalid_request.
Result<api::Move> to_move(const v1::MoveRequest& request);
Result<api::Speeds> to_speeds(const v1::Profile& profile);
Result<stage::Segment> to_segment(const v1::Segment& segment);
// Without its context.
Result<stage::ScanRequest> to_scan(const v1::ScanRequest& request);

}  // namespace axisgate::proto
