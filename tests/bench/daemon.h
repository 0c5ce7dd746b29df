// Calls to the daemon as a client program makes them.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>
#include <vector>

#include "axisgate/v1/command.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"

namespace axisgate::bench {

inline constexpr const char* kDevice = "devices/stage";

// Opens a separate connection, as another program on the machine would have. `certificates` is the folder of
// axisgate-certificates, with the authority "lab" and the caller "anna"; empty: no TLS.
std::shared_ptr<grpc::Channel> connect(const std::string& target, const std::string& certificates = {});

// Throws unless the call succeeded.
void check(const grpc::Status& status);

// Sends the lines, waits for the end of the call, and returns the answers. Throws if the call failed.
std::vector<std::string> execute(v1::CommandService::Stub& commands, const std::vector<std::string>& lines);

// Starts a relative move of axis 1, and returns the name of the motion.
std::string start_move(v1::StageService::Stub& stage, std::int64_t pulses);

}  // namespace axisgate::bench
