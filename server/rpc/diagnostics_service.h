// DiagnosticsService: what went over the lines, and a report for somebody who helps.
#pragma once

#include "axisgate/v1/diagnostics.grpc.pb.h"
#include "server/gateway.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class DiagnosticsService final : public api::DiagnosticsService::CallbackService {
 public:
  // Both outlive this.
  DiagnosticsService(server::Gateway& gateway, StreamLimit& streams) : gateway_(gateway), streams_(streams) {}

  grpc::ServerWriteReactor<api::RecordResponse>* Record(grpc::CallbackServerContext* context,
                                                        const api::RecordRequest* request) override;
  grpc::ServerWriteReactor<api::GetSupportReportResponse>* GetSupportReport(
      grpc::CallbackServerContext* context, const api::GetSupportReportRequest* request) override;

 private:
  server::Gateway& gateway_;
  StreamLimit& streams_;
};

}  // namespace axisgate::rpc
