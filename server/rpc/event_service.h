// EventService: the facts of all devices from a revision on.
#pragma once

#include "axisgate/v1/event.grpc.pb.h"
#include "server/gateway.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class EventService final : public api::EventService::CallbackService {
 public:
  // Both outlive this.
  EventService(server::Gateway& gateway, StreamLimit& streams) : gateway_(gateway), streams_(streams) {}

  grpc::ServerWriteReactor<api::WatchResponse>* Watch(grpc::CallbackServerContext* context,
                                                      const api::WatchRequest* request) override;

 private:
  server::Gateway& gateway_;
  StreamLimit& streams_;
};

}  // namespace axisgate::rpc
