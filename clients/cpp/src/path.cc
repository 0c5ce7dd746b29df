#include "clients/cpp/src/path.h"

namespace axisgate::client {
namespace {

// Segments that are sent in a millisecond at the least; the time for them is added to the limit of the request.
constexpr std::size_t kSegmentsPerMs = 2;

// Sends the path once. The path continues without the call.
grpc::Status send_path(v1::StageService::Stub& stage, grpc::ClientContext& context, const v1::PathHeader& header,
                       const std::vector<v1::Segment>& segments, v1::Motion& motion) {
  const auto call = stage.RunPath(&context);
  v1::RunPathRequest request;
  *request.mutable_header() = header;
  bool sent = call->Write(request);  // if it fails, the call has ended, and Finish() says why
  for (std::size_t i = 0; i < segments.size() && sent; ++i) {
    *request.mutable_segment() = segments[i];
    sent = call->Write(request);
  }
  if (sent) call->WritesDone();
  v1::RunPathResponse response;
  while (call->Read(&response)) {
    if (!response.has_motion()) continue;
    motion = response.motion();
    context.TryCancel();
    (void)call->Finish();
    return grpc::Status::OK;
  }
  const grpc::Status status = call->Finish();
  return status.ok() ? grpc::Status(grpc::UNKNOWN, "the path has no motion") : status;
}

}  // namespace

Motion start_path(DeviceSession& session, const std::vector<v1::Segment>& segments) {
  Connection& connection = session.connection();
  Connection::Action action = connection.new_action(
      session.token(), milliseconds(static_cast<milliseconds::rep>(segments.size() / kSegmentsPerMs)));
  v1::PathHeader header;
  *header.mutable_context() = action.context;
  header.set_device(session.device());
  v1::Motion motion;
  connection.send(session.services(), action.repeat, "RunPathRequest", [&](grpc::ClientContext& context) {
    return send_path(session.services().stage, context, header, segments, motion);
  });
  return session.own_motion(std::move(motion), action.context.request_id());
}

}  // namespace axisgate::client
