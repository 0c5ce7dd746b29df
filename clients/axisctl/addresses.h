// What people type for a daemon and a device, as gRPC and the API want it.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::axisctl {

// "unix:/path" of "/path", and of "lab/x.sock" likewise; "host:50203" of "host"; the default daemon of "". A host
// without a port has the daemon's default port, with TLS the one that the examples of [network] have.
std::string address(std::string_view target, bool tls);

// "devices/stage" of "stage"; "" stays.
std::string resource(const std::string& device);

}  // namespace axisgate::axisctl
