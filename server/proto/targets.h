// Conversion of moves, path segments and scans from callers' messages.
#pragma once

#include "axisgate/v1/stage.pb.h"
#include "device/core/problem.h"
#include "device/stage/requests.h"
#include "server/api/stage/targets.h"

namespace axisgate::proto {

// Fails with unknown_axis or invalid_request.
Result<api::Move> to_move(const v1::MoveRequest& request);
Result<api::Speeds> to_speeds(const v1::Profile& profile);
Result<stage::Segment> to_segment(const v1::Segment& segment);
// Ignores the request's context.
Result<stage::ScanRequest> to_scan(const v1::ScanRequest& request);

}  // namespace axisgate::proto
