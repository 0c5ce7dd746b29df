// The call of Jog: axes run for as long as its client says so.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <memory>
#include <optional>

#include "axisgate/v1/stage.pb.h"
#include "server/access/access.h"
#include "server/gateway.h"
#include "server/rpc/fact_reader.h"
#include "server/rpc/pull_stream.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

// Messages are taken in as they come, whatever becomes of the answers: a client that does not read keeps its jog alive.
class JogRun final : public PullStream<grpc::ServerBidiReactor<api::JogRequest, api::JogResponse>, api::JogResponse> {
 public:
  // `context` is gRPC's and lives as long as the call.
  static JogRun* start(server::Gateway& gateway, const server::Access& access,
                       const grpc::CallbackServerContext& context, Result<StreamLimit::Place> place);

  void OnReadDone(bool ok) override;
  void OnCancel() override;

 private:
  JogRun(server::Gateway& gateway, const server::Access& access, const grpc::CallbackServerContext& context)
      : gateway_(gateway), access_(access), context_(context), reader_(gateway, 0) {}

  Result<void> take_first();
  Result<void> take_renewal();
  void begin(stage::StageController& controller, stage::JogRequest request, TimePoint now);
  void show_or_end(const Result<stage::Motion>& motion);
  void look();
  void refuse(const Problem& problem);
  void stop(std::optional<Problem> why);

  Next next() override;
  void read_changes();
  void show(const stage::Motion& motion, std::uint64_t revision);
  void closed() override { subscription_.reset(); }

  server::Gateway& gateway_;
  const server::Access& access_;
  const grpc::CallbackServerContext& context_;
  StreamLimit::Place place_;
  api::JogRequest incoming_;                       // one read is outstanding at most
  std::atomic<server::Device*> device_ = nullptr;  // null: no message yet

  // On the device's strand.
  stage::MotionId motion_ = 0;  // 0: none
  bool over_ = false;           // the client wants no motion any more

  // Under the stream's lock.
  FactReader reader_;
  stage::MotionId shown_ = 0;  // whose changes are read; 0: not started
  std::optional<api::JogResponse> due_;
  std::optional<grpc::Status> end_;  // after what is due

  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

}  // namespace axisgate::rpc
