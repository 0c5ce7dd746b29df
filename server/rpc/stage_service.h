// StageService: motion, and stopping it.
#pragma once

#include "axisgate/v1/stage.grpc.pb.h"
#include "server/access/access.h"
#include "server/gateway.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class StageService final : public api::StageService::CallbackService {
 public:
  // All outlive this.
  StageService(server::Gateway& gateway, const server::Access& access, StreamLimit& streams)
      : gateway_(gateway), access_(access), streams_(streams) {}

  grpc::ServerUnaryReactor* Move(grpc::CallbackServerContext* context, const api::MoveRequest* request,
                                 api::MoveResponse* response) override;
  grpc::ServerUnaryReactor* Home(grpc::CallbackServerContext* context, const api::HomeRequest* request,
                                 api::HomeResponse* response) override;
  grpc::ServerUnaryReactor* ReturnToOrigin(grpc::CallbackServerContext* context,
                                           const api::ReturnToOriginRequest* request,
                                           api::ReturnToOriginResponse* response) override;
  grpc::ServerBidiReactor<api::RunPathRequest, api::RunPathResponse>* RunPath(
      grpc::CallbackServerContext* context) override;
  grpc::ServerUnaryReactor* Scan(grpc::CallbackServerContext* context, const api::ScanRequest* request,
                                 api::ScanResponse* response) override;
  grpc::ServerBidiReactor<api::JogRequest, api::JogResponse>* Jog(grpc::CallbackServerContext* context) override;
  grpc::ServerUnaryReactor* Stop(grpc::CallbackServerContext* context, const api::StopRequest* request,
                                 api::StopResponse* response) override;
  grpc::ServerUnaryReactor* EmergencyStop(grpc::CallbackServerContext* context,
                                          const api::EmergencyStopRequest* request,
                                          api::EmergencyStopResponse* response) override;
  grpc::ServerUnaryReactor* GetMotion(grpc::CallbackServerContext* context, const api::GetMotionRequest* request,
                                      api::GetMotionResponse* response) override;
  grpc::ServerUnaryReactor* ListMotions(grpc::CallbackServerContext* context, const api::ListMotionsRequest* request,
                                        api::ListMotionsResponse* response) override;
  grpc::ServerWriteReactor<api::WatchMotionResponse>* WatchMotion(grpc::CallbackServerContext* context,
                                                                  const api::WatchMotionRequest* request) override;
  grpc::ServerUnaryReactor* CancelMotion(grpc::CallbackServerContext* context, const api::CancelMotionRequest* request,
                                         api::CancelMotionResponse* response) override;

 private:
  // A path is held whole, up to tens of megabytes: fewer of them than of other streams.
  static constexpr int kPathsMax = 32;

  server::Gateway& gateway_;
  const server::Access& access_;
  StreamLimit& streams_;
  StreamLimit paths_{kPathsMax};
};

}  // namespace axisgate::rpc
