// The call of KeepLeaseAlive.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <memory>

#include "axisgate/v1/control.pb.h"
#include "server/api/sharing/lease_keeping.h"
#include "server/rpc/calls/incoming.h"
#include "server/rpc/calls/subscribed_stream.h"

namespace axisgate::rpc {

// The stream reads the next message after the previous one has been answered.
class LeaseKeeping final
    : public SubscribedStream<grpc::ServerBidiReactor<v1::KeepLeaseAliveRequest, v1::KeepLeaseAliveResponse>,
                              v1::KeepLeaseAliveResponse, server::Lease> {
 public:
  static LeaseKeeping* start(std::shared_ptr<api::LeaseKeeping> keeping);

  explicit LeaseKeeping(std::shared_ptr<api::LeaseKeeping> keeping);
  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;

 private:
  const std::shared_ptr<api::LeaseKeeping> keeping_;
  Incoming<v1::KeepLeaseAliveRequest> incoming_;
};

}  // namespace axisgate::rpc
