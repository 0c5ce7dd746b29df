// The daemon as a client program sees it.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>
#include <vector>

#include "axisgate/v1/command.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"

namespace axisgate::bench {

inline constexpr const char* kDevice = "devices/stage";

// A connection of its own, as another program on the machine would have. `certificates`: the folder of
// axisgate-certificates, in which "lab" is the authority and "anna" the caller; empty: without TLS.
std::shared_ptr<grpc::Channel> connect(const std::string& target, const std::string& certificates = {});

// Throws what is no success.
void check(const grpc::Status& status);

// The answers to the lines, once the call has ended. Throws where it has failed.
std::vector<std::string> execute(v1::CommandService::Stub& commands, const std::vector<std::string>& lines);

// Starts a relative move of axis 1: the name of the motion.
std::string start_move(v1::StageService::Stub& stage, std::int64_t pulses);

}  // namespace axisgate::bench
