// StageService: motion. The front answers stops (call_filter.h).
#pragma once

#include "axisgate/v1/stage.grpc.pb.h"
#include "server/api/stage/jogs.h"
#include "server/api/stage/motions.h"
#include "server/api/stage/paths.h"
#include "server/rpc/calls/half_close.h"

namespace axisgate::rpc {

class StageService final : public v1::StageService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  StageService(const api::Motions& motions, const api::Paths& paths, const api::Jogs& jogs, const HalfClose& half_close)
      : motions_(motions), paths_(paths), jogs_(jogs), half_close_(half_close) {}

  grpc::ServerUnaryReactor* Move(grpc::CallbackServerContext* context, const v1::MoveRequest* request,
                                 v1::MoveResponse* response) override;
  grpc::ServerUnaryReactor* Home(grpc::CallbackServerContext* context, const v1::HomeRequest* request,
                                 v1::HomeResponse* response) override;
  grpc::ServerUnaryReactor* ReturnToOrigin(grpc::CallbackServerContext* context,
                                           const v1::ReturnToOriginRequest* request,
                                           v1::ReturnToOriginResponse* response) override;
  grpc::ServerBidiReactor<v1::RunPathRequest, v1::RunPathResponse>* RunPath(
      grpc::CallbackServerContext* context) override;
  grpc::ServerUnaryReactor* Scan(grpc::CallbackServerContext* context, const v1::ScanRequest* request,
                                 v1::ScanResponse* response) override;
  grpc::ServerBidiReactor<v1::JogRequest, v1::JogResponse>* Jog(grpc::CallbackServerContext* context) override;
  grpc::ServerUnaryReactor* GetMotion(grpc::CallbackServerContext* context, const v1::GetMotionRequest* request,
                                      v1::GetMotionResponse* response) override;
  grpc::ServerUnaryReactor* ListMotions(grpc::CallbackServerContext* context, const v1::ListMotionsRequest* request,
                                        v1::ListMotionsResponse* response) override;
  grpc::ServerWriteReactor<v1::WatchMotionResponse>* WatchMotion(grpc::CallbackServerContext* context,
                                                                 const v1::WatchMotionRequest* request) override;
  grpc::ServerUnaryReactor* CancelMotion(grpc::CallbackServerContext* context, const v1::CancelMotionRequest* request,
                                         v1::CancelMotionResponse* response) override;

 private:
  const api::Motions& motions_;
  const api::Paths& paths_;
  const api::Jogs& jogs_;
  const HalfClose& half_close_;
};

}  // namespace axisgate::rpc
