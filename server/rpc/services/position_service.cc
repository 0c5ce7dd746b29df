// PositionService: saved positions of a stage.
#include <optional>
#include <vector>

#include "axisgate/v1/position.grpc.pb.h"
#include "server/api/stage/positions.h"
#include "server/proto/motions.h"
#include "server/proto/pages.h"
#include "server/proto/positions.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

class PositionService final : public v1::PositionService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  PositionService(const server::Gateway& gateway, const api::Positions& positions)
      : gateway_(gateway), positions_(positions) {}

  grpc::ServerUnaryReactor* SavePosition(grpc::CallbackServerContext* context, const v1::SavePositionRequest* request,
                                         v1::SavePositionResponse* response) override {
    using Saved = std::optional<api::NamedPosition>;
    const auto call = UnaryCall<v1::SavePositionResponse>::start(response);
    positions_.save(to_checked_call(*context, *request), request->position(), proto::to_wish(*request),
                    answering<Saved>(call, [this](v1::SavePositionResponse& answer, const Saved& saved) {
                      if (saved) *answer.mutable_position() = to_proto(*saved);
                    }));
    return call.get();
  }

  grpc::ServerUnaryReactor* ListPositions(grpc::CallbackServerContext* context, const v1::ListPositionsRequest* request,
                                          v1::ListPositionsResponse* response) override {
    using Positions = std::vector<api::NamedPosition>;
    const auto call = UnaryCall<v1::ListPositionsResponse>::start(response);
    if (const auto good = proto::check_page(request->page_size(), request->page_token()); !good)
      return call->refuse(good.error());
    positions_.list(
        to_call(*context), request->device(),
        answering<Positions>(call, [this, asked = *request](v1::ListPositionsResponse& answer, Positions positions) {
          std::erase_if(positions, [&](const api::NamedPosition& one) { return left_out(one, asked.kind()); });
          answer.set_next_page_token(proto::cut_page(positions, asked.page_size(), asked.page_token(),
                                                     [](const api::NamedPosition& one) { return one.position.name; }));
          for (const auto& position : positions) *answer.add_positions() = to_proto(position);
        }));
    return call.get();
  }

  grpc::ServerUnaryReactor* DeletePosition(grpc::CallbackServerContext* context,
                                           const v1::DeletePositionRequest* request,
                                           v1::DeletePositionResponse* response) override {
    const auto call = UnaryCall<v1::DeletePositionResponse>::start(response);
    positions_.remove(to_checked_call(*context, *request), request->position(), answering(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* MoveToPosition(grpc::CallbackServerContext* context,
                                           const v1::MoveToPositionRequest* request,
                                           v1::MoveToPositionResponse* response) override {
    const auto call = UnaryCall<v1::MoveToPositionResponse>::start(response);
    positions_.move_to(
        to_checked_call(*context, *request), request->position(),
        answering<api::StartedMotion>(call, [](v1::MoveToPositionResponse& answer, const api::StartedMotion& motion) {
          if (motion) *answer.mutable_motion() = proto::to_proto(*motion);
        }));
    return call.get();
  }

 private:
  static bool left_out(const api::NamedPosition& one, v1::PositionKind kind) {
    if (kind == v1::POSITION_KIND_UNSPECIFIED) return false;
    return one.position.place != (kind == v1::POSITION_KIND_PLACE);
  }
  v1::Position to_proto(const api::NamedPosition& named) const {
    return proto::to_proto(named, proto::Shown(gateway_.find_stage(named.position.device)));
  }

  const server::Gateway& gateway_;
  const api::Positions& positions_;
};

}  // namespace

std::unique_ptr<grpc::Service> position_service(const ServiceParts& parts) {
  return std::make_unique<PositionService>(parts.gateway, parts.api.positions);
}

}  // namespace axisgate::rpc
