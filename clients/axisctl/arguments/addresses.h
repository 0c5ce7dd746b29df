// Conversion of typed daemon and device names to the forms that gRPC and the API use.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::axisctl {

// Returns the gRPC address of a target: "unix:/path" for "/path", likewise for "lab/x.sock", and "host:50203" for
// "host". An empty target means the local daemon. A host without a port gets the daemon's default port, with TLS the
// port in the examples of [network].
std::string address(std::string_view target, bool tls);

// Returns "devices/stage" for "stage", and "" for "".
std::string resource(const std::string& device);

}  // namespace axisgate::axisctl
