// Who may move what: leases, and stops that stay stopped.
#pragma once

#include <grpcpp/server_context.h>

#include "axisgate/v1/control.grpc.pb.h"
#include "server/gateway.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class ControlService final : public api::ControlService::CallbackService {
 public:
  ControlService(server::Gateway& gateway, StreamLimit& streams) : gateway_(gateway), streams_(streams) {}

  grpc::ServerUnaryReactor* AcquireLease(grpc::CallbackServerContext* context, const api::AcquireLeaseRequest* request,
                                         api::AcquireLeaseResponse* response) override;
  grpc::ServerBidiReactor<api::KeepLeaseAliveRequest, api::KeepLeaseAliveResponse>* KeepLeaseAlive(
      grpc::CallbackServerContext* context) override;
  grpc::ServerUnaryReactor* ReleaseLease(grpc::CallbackServerContext* context, const api::ReleaseLeaseRequest* request,
                                         api::ReleaseLeaseResponse* response) override;
  grpc::ServerUnaryReactor* HandOverLease(grpc::CallbackServerContext* context,
                                          const api::HandOverLeaseRequest* request,
                                          api::HandOverLeaseResponse* response) override;
  grpc::ServerUnaryReactor* TakeOverLease(grpc::CallbackServerContext* context,
                                          const api::TakeOverLeaseRequest* request,
                                          api::TakeOverLeaseResponse* response) override;
  grpc::ServerWriteReactor<api::WatchLeasesResponse>* WatchLeases(grpc::CallbackServerContext* context,
                                                                  const api::WatchLeasesRequest* request) override;
  grpc::ServerUnaryReactor* Rearm(grpc::CallbackServerContext* context, const api::RearmRequest* request,
                                  api::RearmResponse* response) override;

 private:
  server::Gateway& gateway_;
  StreamLimit& streams_;
};

}  // namespace axisgate::rpc
