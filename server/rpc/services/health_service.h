// gRPC's standard health service: SERVING as long as the daemon runs. DeviceService reports the state of devices.
#pragma once

#include <grpc/health/v1/health.grpc.pb.h>

#include <string_view>

#include "server/api/request/streams.h"

namespace axisgate::rpc {

class HealthService final : public grpc::health::v1::Health::CallbackService {
 public:
  explicit HealthService(api::Streams& streams) : streams_(streams) {}

  grpc::ServerUnaryReactor* Check(grpc::CallbackServerContext* context,
                                  const grpc::health::v1::HealthCheckRequest* request,
                                  grpc::health::v1::HealthCheckResponse* response) override;
  grpc::ServerWriteReactor<grpc::health::v1::HealthCheckResponse>* Watch(
      grpc::CallbackServerContext* context, const grpc::health::v1::HealthCheckRequest* request) override;

 private:
  api::Streams& streams_;
};

}  // namespace axisgate::rpc
