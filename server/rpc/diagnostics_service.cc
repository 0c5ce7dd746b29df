#include "server/rpc/diagnostics_service.h"

#include <utility>

#include "server/rpc/call.h"
#include "server/rpc/ended_stream.h"
#include "server/rpc/record_stream.h"
#include "server/rpc/support_report.h"

namespace axisgate::rpc {

grpc::ServerWriteReactor<api::RecordResponse>* DiagnosticsService::Record(grpc::CallbackServerContext*,
                                                                          const api::RecordRequest* request) {
  using Ended = EndedStream<api::RecordResponse>;
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return new Ended(device.error());
  Result<StreamLimit::Place> place = streams_.take();
  if (!place) return new Ended(place.error());
  return RecordStream::start(**device, *request, *std::move(place));
}

grpc::ServerWriteReactor<api::GetSupportReportResponse>* DiagnosticsService::GetSupportReport(
    grpc::CallbackServerContext*, const api::GetSupportReportRequest*) {
  Result<StreamLimit::Place> place = streams_.take();
  if (!place) return new EndedStream<api::GetSupportReportResponse>(place.error());
  return SupportReport::start(gateway_, *std::move(place));
}

}  // namespace axisgate::rpc
