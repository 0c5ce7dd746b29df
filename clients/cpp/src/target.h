// Address of a daemon, and the credentials of the caller.
#pragma once

#include <string>
#include <string_view>

namespace axisgate {
struct ConnectOptions;
}

namespace axisgate::client {

struct Target {
  std::string address;  // in gRPC's form
  bool tls = false;
  std::string ca = {}, certificate = {}, key = {};  // files; empty: not given
  std::string token = {};
};

// Returns the gRPC address of a target: "unix:/path" for "/path", likewise for "lab/x.sock", and "host:50203" for
// "host". An empty target means the local daemon. A host without a port gets the daemon's default port, with TLS the
// port in the examples of [network].
std::string address(std::string_view target, bool tls);

// Throws InvalidArgument if certificate and key do not come together, or a token would be sent unencrypted to another
// machine.
void check(const Target& target);

// Returns the target of the options, checked. An empty option comes from the environment. Throws InvalidArgument.
Target to_target(const ConnectOptions& options);

// Reports whether the daemon runs on this machine.
bool is_local(std::string_view address);

}  // namespace axisgate::client
