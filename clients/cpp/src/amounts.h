// Amounts of the package and of the API.
#pragma once

#include <string>

#include "axisgate/units.h"
#include "axisgate/v1/common.pb.h"

namespace axisgate::client {

// Throws InvalidArgument if the distance is in pulses and not a whole number.
v1::Distance to_message(const Distance& distance);
// Throws InvalidArgument likewise.
v1::Speed to_message(const Speed& speed);

// Returns "mm" for UNIT_MILLIMETERS, and "UNIT 9" for a unit of a newer daemon.
std::string unit_text(v1::Unit unit);

}  // namespace axisgate::client
