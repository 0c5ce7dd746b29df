// Conversion of moves, path segments and scans from callers' messages.
#pragma once

#include <google/protobuf/repeated_field.h>

#include <vector>

#include "axisgate/v1/stage.pb.h"
#include "device/core/problem.h"
#include "device/stage/requests.h"
#include "server/api/request/axis_names.h"
#include "server/api/stage/jogs.h"
#include "server/api/stage/targets.h"

namespace axisgate::proto {

// `names` are those of the request's device. Fail with unknown_axis or invalid_request.
Result<api::Move> to_move(const v1::MoveRequest& request, const api::AxisNames& names);
Result<std::vector<api::JogAxis>> to_jog_axes(const google::protobuf::RepeatedPtrField<v1::AxisJog>& jogs,
                                              const api::AxisNames& names);
Result<api::Speeds> to_speeds(const v1::Profile& profile);
Result<stage::Segment> to_segment(const v1::Segment& segment, const api::AxisNames& names);
// Ignores the request's context.
Result<api::Scan> to_scan(const v1::ScanRequest& request, const api::AxisNames& names);

}  // namespace axisgate::proto
