// MillService: jobs of mills. The front answers AbortJob (own_answers.h).
#include <algorithm>
#include <cstdint>
#include <string>

#include "axisgate/v1/mill.grpc.pb.h"
#include "server/api/mill/mill_subjects.h"
#include "server/api/request/names.h"
#include "server/proto/amounts.h"
#include "server/proto/digest.h"
#include "server/proto/mills.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/half_close.h"
#include "server/rpc/calls/job_upload_run.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

template <class Response>
api::Answer<api::CurrentJob> answering_with_job(std::shared_ptr<UnaryCall<Response>> call) {
  return answering<api::CurrentJob>(std::move(call), [](Response& response, const api::CurrentJob& job) {
    *response.mutable_job() = proto::to_proto(job);
  });
}

template <class Response>
api::Answer<api::CurrentRun> answering_with_run(std::shared_ptr<UnaryCall<Response>> call) {
  return answering<api::CurrentRun>(std::move(call), [](Response& response, const api::CurrentRun& run) {
    if (run.running) *response.mutable_running() = proto::to_proto(run);
  });
}

class MillService final : public v1::MillService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  MillService(const api::MillSubjects& mill, const HalfClose& half_close) : mill_(mill), half_close_(half_close) {}

  grpc::ServerReadReactor<v1::SendJobRequest>* SendJob(grpc::CallbackServerContext* context,
                                                       v1::SendJobResponse* response) override {
    return JobUploadRun::start(mill_.sending, *context, half_close_, response);
  }

  grpc::ServerUnaryReactor* SendJobPiece(grpc::CallbackServerContext* context, const v1::SendJobPieceRequest* request,
                                         v1::SendJobPieceResponse* response) override {
    const auto call = UnaryCall<v1::SendJobPieceResponse>::start(response);
    const v1::JobHeader& header = request->header();
    const std::string digest = proto::digest_of(header);
    mill_.pieces.take(
        to_call(*context, header.context()), header.device(), proto::to_job(header),
        {.header_digest = digest,
         .offset = static_cast<std::uint64_t>(std::max<std::int64_t>(request->offset(), 0)),
         .data = request->data(),
         .last = request->last(),
         .digest_of_all = [digest](const std::string& bytes) { return proto::job_digest(digest, bytes); }},
        answering<api::PieceTaken>(call, [](v1::SendJobPieceResponse& answer, const api::PieceTaken& taken) {
          answer.set_received(static_cast<std::int64_t>(taken.received));
          if (taken.job) *answer.mutable_job() = proto::to_proto(*taken.job);
        }));
    return call.get();
  }

  grpc::ServerUnaryReactor* GetMill(grpc::CallbackServerContext* context, const v1::GetMillRequest* request,
                                    v1::GetMillResponse* response) override {
    const auto call = UnaryCall<v1::GetMillResponse>::start(response);
    mill_.mills.get(to_call(*context), request->device(),
                    answering<api::MillState>(call, [](v1::GetMillResponse& answer, const api::MillState& state) {
                      *answer.mutable_mill() = proto::to_proto(state);
                    }));
    return call.get();
  }

  grpc::ServerWriteReactor<v1::WatchMillResponse>* WatchMill(grpc::CallbackServerContext* context,
                                                             const v1::WatchMillRequest* request) override {
    return serve<v1::WatchMillResponse>(mill_.mills.watch(to_call(*context), request->device()),
                                        [](v1::WatchMillResponse& response, const api::MillState& state) {
                                          *response.mutable_mill() = proto::to_proto(state);
                                        });
  }

  grpc::ServerUnaryReactor* ConfirmJob(grpc::CallbackServerContext* context, const v1::ConfirmJobRequest* request,
                                       v1::ConfirmJobResponse* response) override {
    const auto call = UnaryCall<v1::ConfirmJobResponse>::start(response);
    mill_.waiting.confirm(to_acting_call(*context, *request), request->job(), proto::to_setup(request->seen()),
                          answering_with_job(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* StartJob(grpc::CallbackServerContext* context, const v1::StartJobRequest* request,
                                     v1::StartJobResponse* response) override {
    const auto call = UnaryCall<v1::StartJobResponse>::start(response);
    mill_.starts.start(to_acting_call(*context, *request), request->job(),
                       answering<api::CurrentJob>(call, [](v1::StartJobResponse& answer, const api::CurrentJob& job) {
                         *answer.mutable_job() = proto::to_proto(job);
                         if (job.run_on) *answer.mutable_run_on() = proto::to_proto(*job.run_on);
                       }));
    return call.get();
  }

  grpc::ServerUnaryReactor* PauseJob(grpc::CallbackServerContext* context, const v1::PauseJobRequest* request,
                                     v1::PauseJobResponse* response) override {
    const auto call = UnaryCall<v1::PauseJobResponse>::start(response);
    mill_.mills.pause(to_acting_call(*context, *request), request->device(), request->raise_tool(),
                      answering_with_run(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* ResumeJob(grpc::CallbackServerContext* context, const v1::ResumeJobRequest* request,
                                      v1::ResumeJobResponse* response) override {
    const auto call = UnaryCall<v1::ResumeJobResponse>::start(response);
    mill_.mills.resume(to_acting_call(*context, *request), request->device(), answering_with_run(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* RepeatJob(grpc::CallbackServerContext* context, const v1::RepeatJobRequest* request,
                                      v1::RepeatJobResponse* response) override {
    const auto call = UnaryCall<v1::RepeatJobResponse>::start(response);
    mill_.sending.repeat(to_acting_call(*context, *request), request->job(), proto::to_repeat(*request),
                         answering_with_job(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* ContinueJob(grpc::CallbackServerContext* context, const v1::ContinueJobRequest* request,
                                        v1::ContinueJobResponse* response) override {
    const auto call = UnaryCall<v1::ContinueJobResponse>::start(response);
    mill_.starts.choose_rest(to_acting_call(*context, *request), request->job(),
                             proto::to_line(request->line(), request->column()), answering_with_job(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* context, const v1::CancelJobRequest* request,
                                      v1::CancelJobResponse* response) override {
    const auto call = UnaryCall<v1::CancelJobResponse>::start(response);
    mill_.waiting.cancel(to_acting_call(*context, *request), request->job(),
                         answering<api::CurrentJob>(call, [](v1::CancelJobResponse&, const api::CurrentJob&) {}));
    return call.get();
  }

  grpc::ServerUnaryReactor* CancelJobs(grpc::CallbackServerContext* context, const v1::CancelJobsRequest* request,
                                       v1::CancelJobsResponse* response) override {
    const auto call = UnaryCall<v1::CancelJobsResponse>::start(response);
    mill_.waiting.cancel_all(
        to_acting_call(*context, *request), request->device(), request->owner(),
        answering<api::CancelledJobs>(call, [](v1::CancelJobsResponse& answer, const api::CancelledJobs& cancelled) {
          for (const jobs::JobNumber job : cancelled.jobs) {
            answer.add_jobs(api::job_name(cancelled.mill->name(), job));
          }
        }));
    return call.get();
  }

  grpc::ServerUnaryReactor* MoveJob(grpc::CallbackServerContext* context, const v1::MoveJobRequest* request,
                                    v1::MoveJobResponse* response) override {
    const auto call = UnaryCall<v1::MoveJobResponse>::start(response);
    mill_.waiting.move_first(to_acting_call(*context, *request), request->job(), answering_with_job(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* ReportJobDone(grpc::CallbackServerContext* context, const v1::ReportJobDoneRequest* request,
                                          v1::ReportJobDoneResponse* response) override {
    const auto call = UnaryCall<v1::ReportJobDoneResponse>::start(response);
    mill_.waiting.done(to_acting_call(*context, *request), request->job(),
                       answering<api::CurrentJob>(call, [](v1::ReportJobDoneResponse&, const api::CurrentJob&) {}));
    return call.get();
  }

  grpc::ServerUnaryReactor* OperateMill(grpc::CallbackServerContext* context, const v1::OperateMillRequest* request,
                                        v1::OperateMillResponse* response) override {
    const auto call = UnaryCall<v1::OperateMillResponse>::start(response);
    mill_.operation.operate(to_acting_call(*context, *request), request->device(), proto::to_hand_request(*request),
                            answering<Duration>(call, [](v1::OperateMillResponse& answer, Duration longest) {
                              *answer.mutable_longest_time() = proto::to_proto(longest);
                            }));
    return call.get();
  }

 private:
  const api::MillSubjects& mill_;
  const HalfClose& half_close_;
};

}  // namespace

std::unique_ptr<grpc::Service> mill_service(const ServiceParts& parts) {
  return std::make_unique<MillService>(parts.api.mill, parts.half_close);
}

}  // namespace axisgate::rpc
