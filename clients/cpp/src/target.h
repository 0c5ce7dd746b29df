// Address of a daemon, and the credentials of the caller.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
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

// Returns the target of the options. An empty option comes from the environment. Throws InvalidArgument if certificate
// and key do not come together, or a token would be sent unencrypted to another machine.
Target to_target(const ConnectOptions& options);

// Reports whether the daemon runs on this machine.
bool is_local(std::string_view address);

// Opens a channel, which shares no network connection with other channels. gRPC itself repeats nothing. Throws
// InvalidArgument if a file cannot be read.
std::shared_ptr<grpc::Channel> open_channel(const Target& target);

// Identifies the caller, and the program: the daemon treats all connections of this process as one program.
void identify(const Target& target, grpc::ClientContext& context);

// Returns a random UUID.
std::string new_uuid();

}  // namespace axisgate::client
