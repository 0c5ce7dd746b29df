// DiagnosticsService: recordings of the lines, and the support report.
#pragma once

#include "axisgate/v1/diagnostics.grpc.pb.h"
#include "server/api/looking/diagnostics.h"

namespace axisgate::rpc {

class DiagnosticsService final : public v1::DiagnosticsService::CallbackService {
 public:
  // `diagnostics` must outlive this object.
  explicit DiagnosticsService(const api::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  grpc::ServerWriteReactor<v1::RecordResponse>* Record(grpc::CallbackServerContext* context,
                                                       const v1::RecordRequest* request) override;
  grpc::ServerWriteReactor<v1::GetSupportReportResponse>* GetSupportReport(
      grpc::CallbackServerContext* context, const v1::GetSupportReportRequest* request) override;

 private:
  const api::Diagnostics& diagnostics_;
};

}  // namespace axisgate::rpc
