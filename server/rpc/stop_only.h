// What a connection of the reserve is served: stops; anything else is refused at once.
#pragma once

#include <grpcpp/generic/async_generic_service.h>

#include "axisgate/v1/stage.grpc.pb.h"
#include "server/rpc/stage_service.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

// Stop and EmergencyStop of StageService; the rest of it is left to the server's generic service.
class StopService final : public api::StageService::WithCallbackMethod_Stop<
                              api::StageService::WithCallbackMethod_EmergencyStop<api::StageService::Service>> {
 public:
  // `stage` outlives this.
  explicit StopService(StageService& stage);

  grpc::ServerUnaryReactor* Stop(grpc::CallbackServerContext* context, const api::StopRequest* request,
                                 api::StopResponse* response) override;
  grpc::ServerUnaryReactor* EmergencyStop(grpc::CallbackServerContext* context,
                                          const api::EmergencyStopRequest* request,
                                          api::EmergencyStopResponse* response) override;

 private:
  StageService& stage_;
};

// Answers every call of any service with queue_full and what to do about it.
class RefusingService final : public grpc::CallbackGenericService {
 public:
  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override;
};

}  // namespace axisgate::rpc
