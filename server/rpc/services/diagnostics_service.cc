#include "server/rpc/services/diagnostics_service.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/common.h>
#include <grpcpp/grpcpp.h>

#include "server/proto/to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/subscribed_stream.h"

namespace axisgate::rpc {
namespace {

// Serves RecordResponse and GetSupportReportResponse.
template <class Response>
void fill_text(Response& response, const std::string& text) {
  response.set_text(text);
}

std::string describe(const server::Stage& device, const stage::State& state) {
  return proto::to_proto(device, state).DebugString();
}

std::string versions() {
  return fmt::format("gRPC {}\nprotobuf {}\n", grpc::Version(),
                     google::protobuf::internal::VersionString(GOOGLE_PROTOBUF_VERSION));
}

}  // namespace

grpc::ServerWriteReactor<v1::RecordResponse>* DiagnosticsService::Record(grpc::CallbackServerContext* context,
                                                                         const v1::RecordRequest* request) {
  return serve<v1::RecordResponse>(
      diagnostics_.record(to_call(*context), request->device(), request->skip_kept(), request->follow()),
      fill_text<v1::RecordResponse>);
}

grpc::ServerWriteReactor<v1::GetSupportReportResponse>* DiagnosticsService::GetSupportReport(
    grpc::CallbackServerContext* context, const v1::GetSupportReportRequest*) {
  return serve<v1::GetSupportReportResponse>(diagnostics_.report(to_call(*context), {versions(), describe}),
                                             fill_text<v1::GetSupportReportResponse>);
}

}  // namespace axisgate::rpc
