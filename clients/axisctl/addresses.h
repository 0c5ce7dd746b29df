// What people type for a daemon and a device, as gRPC and the API want it.
#pragma once

#include <string>

namespace axisgate::axisctl {

// "unix:/path" of "/path"; the default daemon of "".
std::string address(std::string target);

// "devices/stage" of "stage"; "" stays.
std::string resource(const std::string& device);

}  // namespace axisgate::axisctl
