// Distances, speeds and axes as callers write them, as exact quantities; and back.
#pragma once

#include <google/protobuf/duration.pb.h>
#include <google/protobuf/repeated_field.h>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"

namespace axisgate::proto {

// invalid_request where no amount is given or it is not an exact decimal.
Result<Quantity> to_quantity(const v1::Distance& distance);
Result<Quantity> to_quantity(const v1::Speed& speed);

v1::Distance to_distance(const Quantity& quantity);
v1::Speed to_speed(const Quantity& quantity);
v1::Unit to_proto(Unit unit);

// As api::checked_axes().
Result<stage::AxisSet> to_axes(const google::protobuf::RepeatedField<google::protobuf::int32>& numbers);

// Below zero for one that is, or that is none; 200 years for anything longer.
Duration to_duration(const google::protobuf::Duration& duration);
google::protobuf::Duration to_proto(Duration duration);

// From no time at all, also for one that is none, to a day.
Duration to_span(const google::protobuf::Duration& duration);

}  // namespace axisgate::proto
