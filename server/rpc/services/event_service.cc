#include "server/rpc/services/event_service.h"

#include "server/proto/to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/subscribed_stream.h"

namespace axisgate::rpc {

grpc::ServerWriteReactor<v1::WatchResponse>* EventService::Watch(grpc::CallbackServerContext* context,
                                                                 const v1::WatchRequest* request) {
  api::EventRange range{.device = request->device(), .run = request->run()};
  if (request->has_from_revision()) range.from = request->from_revision();
  return serve<v1::WatchResponse>(events_.watch(to_call(*context), range),
                                  [](v1::WatchResponse& response, const api::Event& event) {
                                    *response.mutable_event() = proto::to_proto(*event);
                                  });
}

}  // namespace axisgate::rpc
