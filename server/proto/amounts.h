// Conversion of distances, speeds, axes and durations between callers' messages and exact quantities.
#pragma once

#include <google/protobuf/duration.pb.h>
#include <google/protobuf/repeated_field.h>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"

namespace axisgate::proto {

// Fails with invalid_request if no amount is given, or if it is not an exact decimal.
Result<Quantity> to_quantity(const v1::Distance& distance);
Result<Quantity> to_quantity(const v1::Speed& speed);

v1::Distance to_distance(const Quantity& quantity);
v1::Speed to_speed(const Quantity& quantity);
v1::Unit to_proto(Unit unit);

// Fails like api::checked_axes().
Result<stage::AxisSet> to_axes(const google::protobuf::RepeatedField<google::protobuf::int32>& numbers);

// Negative if `duration` is negative or invalid; at most 200 years.
Duration to_duration(const google::protobuf::Duration& duration);
google::protobuf::Duration to_proto(Duration duration);

// Limits the duration to 0 to 24 hours. A negative or invalid duration becomes 0.
Duration to_span(const google::protobuf::Duration& duration);

}  // namespace axisgate::proto
