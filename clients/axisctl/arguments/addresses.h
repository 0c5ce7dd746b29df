// Conversion of typed device names to the form that the API uses.
#pragma once

#include <string>

namespace axisgate::axisctl {

// Returns "devices/stage" for "stage", and "" for "".
std::string resource(const std::string& device);

}  // namespace axisgate::axisctl
