// The call of RunPath: takes the whole path in, runs it, and tells of its progress until its outcome.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

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

class PathRun final
    : public PullStream<grpc::ServerBidiReactor<api::RunPathRequest, api::RunPathResponse>, api::RunPathResponse> {
 public:
  // `context` is gRPC's and lives as long as the call.
  static PathRun* start(server::Gateway& gateway, const server::Access& access,
                        const grpc::CallbackServerContext& context, Result<StreamLimit::Place> place);

  void OnReadDone(bool ok) override;

 private:
  PathRun(server::Gateway& gateway, const server::Access& access, const grpc::CallbackServerContext& context)
      : gateway_(gateway), access_(access), context_(context), reader_(gateway, 0) {}

  Result<void> take(const api::RunPathRequest& part);
  Result<void> take(const api::PathHeader& header);
  Result<void> take(const api::Segment& segment);
  void begin();
  void run(stage::StageController& controller, TimePoint now);
  void on_started(const Result<stage::Motion>& motion);
  void end(grpc::Status status);

  Next next() override;
  void read_progress();
  void closed() override { subscription_.reset(); }

  server::Gateway& gateway_;
  const server::Access& access_;
  const grpc::CallbackServerContext& context_;
  StreamLimit::Place place_;

  // While the path comes in; one read is outstanding at most.
  api::RunPathRequest incoming_;
  server::Device* device_ = nullptr;  // null: no header yet
  api::CallContext header_context_;
  bool validate_only_ = false;
  stage::PathRequest path_;

  // Under the stream's lock.
  FactReader reader_;
  stage::MotionId motion_ = 0;  // 0: not started
  std::optional<api::RunPathResponse> due_;
  std::optional<grpc::Status> end_;  // after what is due

  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

}  // namespace axisgate::rpc
