// MillService: jobs of mills. The front answers AbortJob (own_answers.h).
#pragma once

#include "axisgate/v1/mill.grpc.pb.h"
#include "server/api/mill/mill_subjects.h"
#include "server/rpc/calls/half_close.h"

namespace axisgate::rpc {

class MillService final : public v1::MillService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  MillService(const api::MillSubjects& mill, const HalfClose& half_close) : mill_(mill), half_close_(half_close) {}

  grpc::ServerReadReactor<v1::SendJobRequest>* SendJob(grpc::CallbackServerContext* context,
                                                       v1::SendJobResponse* response) override;
  grpc::ServerUnaryReactor* GetMill(grpc::CallbackServerContext* context, const v1::GetMillRequest* request,
                                    v1::GetMillResponse* response) override;
  grpc::ServerWriteReactor<v1::WatchMillResponse>* WatchMill(grpc::CallbackServerContext* context,
                                                             const v1::WatchMillRequest* request) override;
  grpc::ServerUnaryReactor* ConfirmJob(grpc::CallbackServerContext* context, const v1::ConfirmJobRequest* request,
                                       v1::ConfirmJobResponse* response) override;
  grpc::ServerUnaryReactor* StartJob(grpc::CallbackServerContext* context, const v1::StartJobRequest* request,
                                     v1::StartJobResponse* response) override;
  grpc::ServerUnaryReactor* PauseJob(grpc::CallbackServerContext* context, const v1::PauseJobRequest* request,
                                     v1::PauseJobResponse* response) override;
  grpc::ServerUnaryReactor* ResumeJob(grpc::CallbackServerContext* context, const v1::ResumeJobRequest* request,
                                      v1::ResumeJobResponse* response) override;
  grpc::ServerUnaryReactor* RepeatJob(grpc::CallbackServerContext* context, const v1::RepeatJobRequest* request,
                                      v1::RepeatJobResponse* response) override;
  grpc::ServerUnaryReactor* ContinueJob(grpc::CallbackServerContext* context, const v1::ContinueJobRequest* request,
                                        v1::ContinueJobResponse* response) override;
  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* context, const v1::CancelJobRequest* request,
                                      v1::CancelJobResponse* response) override;
  grpc::ServerUnaryReactor* CancelJobs(grpc::CallbackServerContext* context, const v1::CancelJobsRequest* request,
                                       v1::CancelJobsResponse* response) override;
  grpc::ServerUnaryReactor* MoveJob(grpc::CallbackServerContext* context, const v1::MoveJobRequest* request,
                                    v1::MoveJobResponse* response) override;
  grpc::ServerUnaryReactor* ReportJobDone(grpc::CallbackServerContext* context, const v1::ReportJobDoneRequest* request,
                                          v1::ReportJobDoneResponse* response) override;
  grpc::ServerUnaryReactor* OperateMill(grpc::CallbackServerContext* context, const v1::OperateMillRequest* request,
                                        v1::OperateMillResponse* response) override;

 private:
  const api::MillSubjects& mill_;
  const HalfClose& half_close_;
};

}  // namespace axisgate::rpc
