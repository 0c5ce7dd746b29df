// The call of SendJob: receives the whole job, then answers with its place in the queue.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "axisgate/v1/mill.pb.h"
#include "server/api/mill/job_sending.h"
#include "server/rpc/calls/half_close.h"
#include "server/rpc/calls/incoming.h"
#include "server/spool/sha256.h"

namespace axisgate::rpc {

class JobUploadRun final : public grpc::ServerReadReactor<v1::SendJobRequest>,
                           public std::enable_shared_from_this<JobUploadRun> {
 public:
  // `context` and `response` are gRPC's and live as long as the call. The other objects must outlive this one.
  static JobUploadRun* start(const api::JobSending& sending, const grpc::CallbackServerContext& context,
                             const HalfClose& half_close, v1::SendJobResponse* response);

  void OnReadDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override { self_.reset(); }

 private:
  JobUploadRun(const api::JobSending& sending, const grpc::CallbackServerContext& context, const HalfClose& half_close,
               v1::SendJobResponse* response)
      : sending_(sending), context_(context), half_close_(half_close), response_(response) {}

  Result<void> take();
  Result<void> begin(const v1::SendJobRequest& message);
  void finish();
  void end(const grpc::Status& status);
  void answer(const Result<api::CurrentJob>& job);

  const api::JobSending& sending_;
  const grpc::CallbackServerContext& context_;
  const HalfClose& half_close_;
  v1::SendJobResponse* const response_;
  Incoming<v1::SendJobRequest> incoming_;
  std::unique_ptr<api::JobUpload> upload_;  // null before the first message
  std::string header_digest_;               // of the first message
  server::spool::Sha256 data_digest_;       // of all data, independent of the division into messages
  std::mutex mutex_;
  bool ended_ = false;  // protected by mutex_
  std::shared_ptr<JobUploadRun> self_;
};

}  // namespace axisgate::rpc
