#include "server/rpc/endpoints.h"

#include <grpcpp/security/server_credentials.h>

#include <string>
#include <utility>

#include "server/rpc/network_credentials.h"

namespace axisgate::rpc {
namespace {

using Credentials = std::shared_ptr<grpc::ServerCredentials>;

// Insecure credentials take no processor. To a client these are the same: no byte of a handshake is exchanged.
Credentials local(grpc_local_connect_type type) { return grpc::experimental::LocalServerCredentials(type); }

std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> add(grpc::ServerBuilder& builder,
                                                                    const Credentials& credentials, const Gate& gate,
                                                                    Gatekeeper::Name name, api::Credential unnamed) {
  using Type = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
  credentials->SetAuthMetadataProcessor(std::make_shared<Gatekeeper>(gate, std::move(name), std::move(unnamed)));
  return builder.experimental().AddExternalConnectionAcceptor(Type::FROM_FD, credentials);
}

}  // namespace

Endpoints::Endpoints(grpc::ServerBuilder& builder, const server::CallerSlots& callers, const Gate& gate,
                     const std::optional<server::NetworkConfig>& network) {
  const auto anonymous = [](const grpc::AuthContext&) { return std::optional<std::string>(); };
  loopback_ = add(builder, local(LOCAL_TCP), gate, anonymous, {.who = kAnonymous});
  for (std::size_t slot = 0; slot < callers.size(); ++slot) {
    const auto user = [name = &callers.name(slot)](const grpc::AuthContext&) { return std::optional(*name); };
    unix_.push_back(add(builder, local(UDS), gate, user, {}));
  }
  if (!network) return;
  network_ = add(builder, network_credentials(*network), gate, name_in_certificate,
                 {.who = "a caller over the network without a certificate", .needs_token = true});
}

void Endpoints::enter(Descriptor connection, server::Acceptor::Origin origin, std::optional<std::size_t> slot) {
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
  parameters.fd = connection.release();
  const bool far = origin == server::Acceptor::Origin::network;
  const Endpoint& endpoint = far ? network_ : slot ? unix_[*slot] : loopback_;
  endpoint->HandleNewConnection(&parameters);
}

}  // namespace axisgate::rpc
