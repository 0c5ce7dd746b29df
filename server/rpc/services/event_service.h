// EventService: the events of all devices from a revision on.
#pragma once

#include "axisgate/v1/event.grpc.pb.h"
#include "server/api/looking/events.h"

namespace axisgate::rpc {

class EventService final : public v1::EventService::CallbackService {
 public:
  // `events` must outlive this object.
  explicit EventService(const api::Events& events) : events_(events) {}

  grpc::ServerWriteReactor<v1::WatchResponse>* Watch(grpc::CallbackServerContext* context,
                                                     const v1::WatchRequest* request) override;

 private:
  const api::Events& events_;
};

}  // namespace axisgate::rpc
