#include "server/rpc/entrances.h"

#include <grpcpp/security/server_credentials.h>

#include <string>
#include <utility>

#include "server/rpc/gatekeeper.h"

namespace axisgate::rpc {
namespace {

// Insecure credentials take no processor. To a client these are the same: no byte of a handshake is exchanged.
std::shared_ptr<grpc::ServerCredentials> local(grpc_local_connect_type type, const server::Access& access,
                                               const std::string* user) {
  auto credentials = grpc::experimental::LocalServerCredentials(type);
  credentials->SetAuthMetadataProcessor(std::make_shared<Gatekeeper>(access, user));
  return credentials;
}

std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> add(
    grpc::ServerBuilder& builder, const std::shared_ptr<grpc::ServerCredentials>& credentials) {
  using Type = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
  return builder.experimental().AddExternalConnectionAcceptor(Type::FROM_FD, credentials);
}

}  // namespace

Entrances::Entrances(grpc::ServerBuilder& builder, const server::CallerSlots& callers, const server::Access& access)
    : tcp_(add(builder, local(LOCAL_TCP, access, nullptr))) {
  for (std::size_t slot = 0; slot < callers.size(); ++slot) {
    unix_.push_back(add(builder, local(UDS, access, &callers.name(slot))));
  }
}

void Entrances::enter(Descriptor connection, std::optional<std::size_t> slot) {
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
  parameters.fd = connection.release();
  (slot ? unix_[*slot] : tcp_)->HandleNewConnection(&parameters);
}

}  // namespace axisgate::rpc
