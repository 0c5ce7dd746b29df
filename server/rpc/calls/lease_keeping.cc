#include "server/rpc/calls/lease_keeping.h"

#include <utility>

#include "server/proto/lease_to_proto.h"
#include "server/rpc/calls/unreadable.h"

namespace axisgate::rpc {
namespace {

constexpr const char* kKeepMethod = "/axisgate.v1.ControlService/KeepLeaseAlive";

}  // namespace

LeaseKeeping* LeaseKeeping::start(std::shared_ptr<api::LeaseKeeping> keeping) {
  const auto call = std::make_shared<LeaseKeeping>(std::move(keeping));
  call->serve();
  call->StartRead(call->incoming_.marked());
  return call.get();
}

LeaseKeeping::LeaseKeeping(std::shared_ptr<api::LeaseKeeping> keeping)
    : SubscribedStream(keeping, [](v1::KeepLeaseAliveResponse& response,
                                   const server::Lease& lease) { *response.mutable_lease() = proto::to_proto(lease); }),
      keeping_(std::move(keeping)) {}

// A client that half-closes the stream renews no longer, but its connection did not break off.
void LeaseKeeping::OnReadDone(bool ok) {
  if (ok) return keeping_->keep(incoming_->device(), incoming_->lease_token());
  incoming_.unreadable() ? keeping_->refuse(not_readable(kKeepMethod)) : keeping_->finish();
}

// The read starts within gRPC's own callback: anywhere else, the call could have ended already.
void LeaseKeeping::OnWriteDone(bool ok) {
  if (ok) StartRead(incoming_.marked());
  SubscribedStream::OnWriteDone(ok);
}

void LeaseKeeping::OnCancel() {
  keeping_->break_off();
  SubscribedStream::OnCancel();
}

}  // namespace axisgate::rpc
