// PositionService: saved positions of a stage.
#pragma once

#include "axisgate/v1/position.grpc.pb.h"
#include "server/api/stage/positions.h"

namespace axisgate::rpc {

class PositionService final : public v1::PositionService::CallbackService {
 public:
  // `positions` must outlive this object.
  explicit PositionService(const api::Positions& positions) : positions_(positions) {}

  grpc::ServerUnaryReactor* SavePosition(grpc::CallbackServerContext* context, const v1::SavePositionRequest* request,
                                         v1::SavePositionResponse* response) override;
  grpc::ServerUnaryReactor* ListPositions(grpc::CallbackServerContext* context, const v1::ListPositionsRequest* request,
                                          v1::ListPositionsResponse* response) override;
  grpc::ServerUnaryReactor* DeletePosition(grpc::CallbackServerContext* context,
                                           const v1::DeletePositionRequest* request,
                                           v1::DeletePositionResponse* response) override;
  grpc::ServerUnaryReactor* MoveToPosition(grpc::CallbackServerContext* context,
                                           const v1::MoveToPositionRequest* request,
                                           v1::MoveToPositionResponse* response) override;

 private:
  const api::Positions& positions_;
};

}  // namespace axisgate::rpc
