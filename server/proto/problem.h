// Problems as messages of the API.
#pragma once

#include <map>
#include <string>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"

namespace axisgate::proto {

using Metadata = std::map<std::string, std::string>;

// Escapes the device's text in the problem.
v1::Problem to_proto(const Problem& problem, const Metadata& metadata = {});

}  // namespace axisgate::proto
