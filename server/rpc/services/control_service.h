// ControlService: leases, and the latches that other callers' stops set.
#pragma once

#include "axisgate/v1/control.grpc.pb.h"
#include "server/api/sharing/leases.h"

namespace axisgate::rpc {

class ControlService final : public v1::ControlService::CallbackService {
 public:
  // `leases` must outlive this object.
  explicit ControlService(const api::Leases& leases) : leases_(leases) {}

  grpc::ServerUnaryReactor* AcquireLease(grpc::CallbackServerContext* context, const v1::AcquireLeaseRequest* request,
                                         v1::AcquireLeaseResponse* response) override;
  grpc::ServerBidiReactor<v1::KeepLeaseAliveRequest, v1::KeepLeaseAliveResponse>* KeepLeaseAlive(
      grpc::CallbackServerContext* context) override;
  grpc::ServerUnaryReactor* ReleaseLease(grpc::CallbackServerContext* context, const v1::ReleaseLeaseRequest* request,
                                         v1::ReleaseLeaseResponse* response) override;
  grpc::ServerUnaryReactor* HandOverLease(grpc::CallbackServerContext* context, const v1::HandOverLeaseRequest* request,
                                          v1::HandOverLeaseResponse* response) override;
  grpc::ServerUnaryReactor* TakeOverLease(grpc::CallbackServerContext* context, const v1::TakeOverLeaseRequest* request,
                                          v1::TakeOverLeaseResponse* response) override;
  grpc::ServerWriteReactor<v1::WatchLeasesResponse>* WatchLeases(grpc::CallbackServerContext* context,
                                                                 const v1::WatchLeasesRequest* request) override;
  grpc::ServerUnaryReactor* Rearm(grpc::CallbackServerContext* context, const v1::RearmRequest* request,
                                  v1::RearmResponse* response) override;

 private:
  const api::Leases& leases_;
};

}  // namespace axisgate::rpc
