#include "server/rpc/entrances.h"

#include <grpcpp/security/auth_metadata_processor.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_context.h>

#include <mutex>
#include <utility>

namespace axisgate::rpc {
namespace {

constexpr const char* kCaller = "axisgate_caller";

// Notes on each connection of an entrance who is at its other end.
class CallerNote final : public grpc::AuthMetadataProcessor {
 public:
  explicit CallerNote(const std::string& caller) : caller_(caller) {}

  // It waits for nothing, and so needs no thread of gRPC's pool.
  bool IsBlocking() const override { return false; }

  // Before the handler of every call. The context is the connection's, and has no lock of its own: with ours it changes
  // once, before its first handler reads it.
  grpc::Status Process(const InputMetadata&, grpc::AuthContext* connection, OutputMetadata*, OutputMetadata*) override {
    const std::lock_guard lock(mutex_);
    if (connection->FindPropertyValues(kCaller).empty()) connection->AddProperty(kCaller, caller_);
    return grpc::Status::OK;
  }

 private:
  const std::string& caller_;
  std::mutex mutex_;
};

std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> add(
    grpc::ServerBuilder& builder, const std::shared_ptr<grpc::ServerCredentials>& credentials) {
  using Type = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
  return builder.experimental().AddExternalConnectionAcceptor(Type::FROM_FD, credentials);
}

}  // namespace

Entrances::Entrances(grpc::ServerBuilder& builder, const server::CallerSlots& callers)
    : tcp_(add(builder, grpc::InsecureServerCredentials())) {
  for (std::size_t slot = 0; slot < callers.size(); ++slot) {
    // Insecure ones take no processor. To a client these are the same: no byte of a handshake is exchanged.
    const auto credentials = grpc::experimental::LocalServerCredentials(UDS);
    credentials->SetAuthMetadataProcessor(std::make_shared<CallerNote>(callers.name(slot)));
    unix_.push_back(add(builder, credentials));
  }
}

void Entrances::enter(Descriptor connection, std::optional<std::size_t> slot) {
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
  parameters.fd = connection.release();
  (slot ? unix_[*slot] : tcp_)->HandleNewConnection(&parameters);
}

std::optional<std::string> unix_caller(const grpc::CallbackServerContext& call) {
  const std::vector<grpc::string_ref> callers = call.auth_context()->FindPropertyValues(kCaller);
  if (callers.empty()) return std::nullopt;
  return std::string(callers.front().data(), callers.front().size());
}

}  // namespace axisgate::rpc
