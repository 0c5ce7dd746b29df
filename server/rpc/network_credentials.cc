#include "server/rpc/network_credentials.h"

#include <grpc/grpc_security_constants.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "server/access/access.h"

namespace axisgate::rpc {
namespace {

constexpr unsigned kLookForNewFilesSeconds = 1;
constexpr std::size_t kNameBytesMax = 64;  // X.520's upper bound of a common name

}  // namespace

// gRPC 1.51 has no option for it, but one for the ciphers of TLS 1.2: this one needs a key that both know beforehand,
// which the daemon has none of, so that no handshake by TLS 1.2 ends well. Those of 1.3 are another list.
void allow_only_tls_13() { ::setenv("GRPC_SSL_CIPHER_SUITES", "PSK-AES256-GCM-SHA384", 1); }

std::shared_ptr<grpc::ServerCredentials> network_credentials(const server::NetworkConfig& network) {
  namespace tls = grpc::experimental;
  tls::TlsServerCredentialsOptions options(std::make_shared<tls::FileWatcherCertificateProvider>(
      network.key, network.certificate, network.client_ca, kLookForNewFilesSeconds));
  options.watch_identity_key_cert_pairs();
  if (!network.client_ca.empty()) {
    options.watch_root_certs();
    options.set_cert_request_type(GRPC_SSL_REQUEST_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return tls::TlsServerCredentials(options);
}

std::optional<std::string> name_in_certificate(const grpc::AuthContext& connection) {
  const std::vector<grpc::string_ref> names = connection.FindPropertyValues(GRPC_X509_CN_PROPERTY_NAME);
  if (names.size() != 1 || names[0].empty() || names[0].size() > kNameBytesMax) return std::nullopt;
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (!std::all_of(names[0].begin(), names[0].end(), printable)) return std::nullopt;
  return server::certificate_caller(std::string(names[0].data(), names[0].size()));
}

}  // namespace axisgate::rpc
