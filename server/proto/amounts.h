// Conversion of distances, speeds, axes and durations between callers' messages and exact quantities.
#pragma once

#include <google/protobuf/duration.pb.h>
#include <google/protobuf/repeated_field.h>

#include <string>
#include <string_view>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"
#include "server/api/request/axis_names.h"

namespace axisgate::proto {

// Fail with invalid_request if no amount is given, or if it is not a decimal or a finite number with a unit.
Result<Quantity> to_quantity(const v1::Distance& distance);
Result<Quantity> to_quantity(const v1::Speed& speed);

v1::Distance to_distance(const Quantity& quantity);
v1::Speed to_speed(const Quantity& quantity);
v1::Unit to_proto(Unit unit);

// Inputs or outputs as bits: pin 1 is 1, pin 2 is 2, pin 3 is 4. Fails with out_of_range for a pin that the
// controllers do not have: they have six of each (manual 95) I:, 96) O:).
Result<int> to_bits(const v1::Pins& pins);
v1::Pins to_pins(int bits);

// Mode and format of commands as the controller writes them. Return UNSPECIFIED for a word that the API does not know,
// and an empty text for a number that it does not know.
v1::Mode to_mode(std::string_view text);
std::string to_text(v1::Mode mode);
v1::CommandFormat to_format(std::string_view text);
std::string to_text(v1::CommandFormat format);

// Fails like AxisNames::find_all().
Result<stage::AxisSet> to_axes(const google::protobuf::RepeatedPtrField<std::string>& axes,
                               const api::AxisNames& names);

// Negative if `duration` is negative or invalid; at most 200 years.
Duration to_duration(const google::protobuf::Duration& duration);
google::protobuf::Duration to_proto(Duration duration);

// Fails with not_representable for a part of a millisecond, and with out_of_range above an hour or below 0.
Result<int> to_milliseconds(const google::protobuf::Duration& duration);

// Limits the duration to 0 to 24 hours. A negative or invalid duration becomes 0.
Duration to_span(const google::protobuf::Duration& duration);

}  // namespace axisgate::proto
