// PositionService: places of a stage with names.
#pragma once

#include "axisgate/v1/position.grpc.pb.h"
#include "server/access/access.h"
#include "server/devices/saved_positions.h"
#include "server/gateway.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class PositionService final : public api::PositionService::CallbackService {
 public:
  // `gateway` and `access` outlive this, and `positions` the gateway.
  PositionService(server::Gateway& gateway, const server::Access& access, server::SavedPositions& positions)
      : gateway_(gateway), access_(access), positions_(positions) {}

  grpc::ServerUnaryReactor* SavePosition(grpc::CallbackServerContext* context, const api::SavePositionRequest* request,
                                         api::SavePositionResponse* response) override;
  grpc::ServerUnaryReactor* ListPositions(grpc::CallbackServerContext* context,
                                          const api::ListPositionsRequest* request,
                                          api::ListPositionsResponse* response) override;
  grpc::ServerUnaryReactor* DeletePosition(grpc::CallbackServerContext* context,
                                           const api::DeletePositionRequest* request,
                                           api::DeletePositionResponse* response) override;
  grpc::ServerUnaryReactor* MoveToPosition(grpc::CallbackServerContext* context,
                                           const api::MoveToPositionRequest* request,
                                           api::MoveToPositionResponse* response) override;

 private:
  server::Gateway& gateway_;
  const server::Access& access_;
  server::SavedPositions& positions_;
};

}  // namespace axisgate::rpc
