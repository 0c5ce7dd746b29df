// EventService: the events of all devices from a revision on.
#include "axisgate/v1/event.grpc.pb.h"
#include "server/api/looking/events.h"
#include "server/proto/to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

class EventService final : public v1::EventService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  EventService(const server::Gateway& gateway, const api::Events& events) : gateway_(gateway), events_(events) {}

  grpc::ServerWriteReactor<v1::WatchResponse>* Watch(grpc::CallbackServerContext* context,
                                                     const v1::WatchRequest* request) override {
    api::EventRange range{.device = request->device(), .run = request->run()};
    if (request->has_from_revision()) range.from = request->from_revision();
    return serve<v1::WatchResponse>(events_.watch(to_call(*context), range),
                                    [&gateway = gateway_](v1::WatchResponse& response, const api::Event& event) {
                                      *response.mutable_event() =
                                          proto::to_proto(*event, gateway.find_stage(event->device));
                                    });
  }

 private:
  const server::Gateway& gateway_;
  const api::Events& events_;
};

}  // namespace

std::unique_ptr<grpc::Service> event_service(const ServiceParts& parts) {
  return std::make_unique<EventService>(parts.gateway, parts.api.events);
}

}  // namespace axisgate::rpc
