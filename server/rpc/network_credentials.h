// TLS for those who call from other machines.
#pragma once

#include <grpcpp/security/auth_context.h>
#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <optional>
#include <string>

#include "server/config/config.h"

namespace axisgate::rpc {

// From now on gRPC serves TLS 1.3 only. Before it has made any credentials.
void allow_only_tls_13();

// The daemon's own certificate, and who may sign those of callers. Both are read again within seconds of being
// replaced, and open connections are not affected. A caller without a certificate is admitted at this stage.
std::shared_ptr<grpc::ServerCredentials> network_credentials(const server::NetworkConfig& network);

// "cert alice", after the common name of the caller's certificate; nothing without one, or where it will not do as a
// name.
std::optional<std::string> name_in_certificate(const grpc::AuthContext& connection);

}  // namespace axisgate::rpc
