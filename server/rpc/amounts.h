// Distances, speeds and axes as callers write them, as exact quantities; and back.
#pragma once

#include <google/protobuf/repeated_field.h>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/stage/axes.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

// invalid_request where no amount is given or it is not an exact decimal.
Result<Quantity> to_quantity(const api::Distance& distance);
Result<Quantity> to_quantity(const api::Speed& speed);

api::Distance to_distance(const Quantity& quantity);
api::Speed to_speed(const Quantity& quantity);
api::Unit to_proto(Unit unit);

// Each 1 to 3, once: else unknown_axis or invalid_request. No axes stay no axes.
Result<stage::AxisSet> to_axes(const google::protobuf::RepeatedField<google::protobuf::int32>& numbers);
Result<int> to_axis(int number);

}  // namespace axisgate::rpc
