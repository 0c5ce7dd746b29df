// DiagnosticsService: recordings of the lines, and the support report.
#include <fmt/format.h>
#include <google/protobuf/stubs/common.h>
#include <grpcpp/grpcpp.h>

#include "axisgate/v1/diagnostics.grpc.pb.h"
#include "server/api/looking/diagnostics.h"
#include "server/proto/to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/services.h"

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

class DiagnosticsService final : public v1::DiagnosticsService::CallbackService {
 public:
  // `diagnostics` must outlive this object.
  explicit DiagnosticsService(const api::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  grpc::ServerWriteReactor<v1::RecordResponse>* Record(grpc::CallbackServerContext* context,
                                                       const v1::RecordRequest* request) override {
    return serve<v1::RecordResponse>(
        diagnostics_.record(to_call(*context), request->device(), request->skip_kept(), request->follow()),
        fill_text<v1::RecordResponse>);
  }

  grpc::ServerWriteReactor<v1::GetSupportReportResponse>* GetSupportReport(
      grpc::CallbackServerContext* context, const v1::GetSupportReportRequest*) override {
    return serve<v1::GetSupportReportResponse>(diagnostics_.report(to_call(*context), {versions(), describe}),
                                               fill_text<v1::GetSupportReportResponse>);
  }

 private:
  const api::Diagnostics& diagnostics_;
};

}  // namespace

std::unique_ptr<grpc::Service> diagnostics_service(const ServiceParts& parts) {
  return std::make_unique<DiagnosticsService>(parts.api.diagnostics);
}

}  // namespace axisgate::rpc
