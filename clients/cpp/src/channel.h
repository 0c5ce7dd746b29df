// The connection to a daemon.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>

#include "clients/cpp/src/target.h"

namespace axisgate::client {

// Opens a channel, which shares no network connection with other channels of this process. gRPC itself repeats nothing.
// Throws InvalidArgument if a file cannot be read.
std::shared_ptr<grpc::Channel> open_channel(const Target& target);

}  // namespace axisgate::client
