// A daemon with a stage and one mill, whose answers a test sets, and axisctl's verbs on it, within the process of the
// test.
#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/mill.grpc.pb.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Keeps what was requested. Each vector of answers is used from its front; the last answer stays.
class ScriptedMill : public v1::MillService::Service, public v1::DeviceService::Service {
 public:
  std::vector<grpc::Status> statuses{grpc::Status::OK};  // of the calls that change something
  v1::Mill mill;
  v1::ListDevicesResponse there;
  std::vector<v1::Mill> watched;  // then the stream stays open, unless watch_ends
  bool watch_ends = false;

  std::vector<std::string> calls;  // "SendJob", in their order
  std::vector<v1::SendJobRequest> sent;
  std::vector<v1::ConfirmJobRequest> confirmed;
  std::vector<v1::StartJobRequest> started;
  std::vector<v1::PauseJobRequest> paused;
  std::vector<v1::ContinueJobRequest> continued;
  std::vector<v1::RepeatJobRequest> repeated;
  std::vector<std::string> cleared;        // whose jobs
  std::vector<std::string> devices, jobs;  // that were named by the other requests

  grpc::Status ListDevices(grpc::ServerContext* context, const v1::ListDevicesRequest* request,
                           v1::ListDevicesResponse* response) override;
  grpc::Status SendJob(grpc::ServerContext* context, grpc::ServerReader<v1::SendJobRequest>* reader,
                       v1::SendJobResponse* response) override;
  grpc::Status GetMill(grpc::ServerContext* context, const v1::GetMillRequest* request,
                       v1::GetMillResponse* response) override;
  grpc::Status WatchMill(grpc::ServerContext* context, const v1::WatchMillRequest* request,
                         grpc::ServerWriter<v1::WatchMillResponse>* writer) override;
  grpc::Status ConfirmJob(grpc::ServerContext* context, const v1::ConfirmJobRequest* request,
                          v1::ConfirmJobResponse* response) override;
  grpc::Status StartJob(grpc::ServerContext* context, const v1::StartJobRequest* request,
                        v1::StartJobResponse* response) override;
  grpc::Status PauseJob(grpc::ServerContext* context, const v1::PauseJobRequest* request,
                        v1::PauseJobResponse* response) override;
  grpc::Status ResumeJob(grpc::ServerContext* context, const v1::ResumeJobRequest* request,
                         v1::ResumeJobResponse* response) override;
  grpc::Status AbortJob(grpc::ServerContext* context, const v1::AbortJobRequest* request,
                        v1::AbortJobResponse* response) override;
  grpc::Status RepeatJob(grpc::ServerContext* context, const v1::RepeatJobRequest* request,
                         v1::RepeatJobResponse* response) override;
  grpc::Status ContinueJob(grpc::ServerContext* context, const v1::ContinueJobRequest* request,
                           v1::ContinueJobResponse* response) override;
  grpc::Status CancelJob(grpc::ServerContext* context, const v1::CancelJobRequest* request,
                         v1::CancelJobResponse* response) override;
  grpc::Status CancelJobs(grpc::ServerContext* context, const v1::CancelJobsRequest* request,
                          v1::CancelJobsResponse* response) override;
  grpc::Status MoveJob(grpc::ServerContext* context, const v1::MoveJobRequest* request,
                       v1::MoveJobResponse* response) override;
  grpc::Status ReportJobDone(grpc::ServerContext* context, const v1::ReportJobDoneRequest* request,
                             v1::ReportJobDoneResponse* response) override;

 private:
  grpc::Status next_status();
};

// How a verb ended: as main() has it.
struct Ended {
  int exit_code = 0;
  std::string output, reason, message, hint;  // without a Failure the last three are empty
};

class MillVerbs : public ::testing::Test {
 protected:
  MillVerbs();
  ~MillVerbs() override;

  Ended run(int (*verb)(const Session&));

  // Among the devices that there are.
  void add_device(const std::string& name, const std::string& kind);
  // Numbers 7, 8, ...; of 30,000 bytes.
  v1::Job& add_job(v1::JobState state);

  ScriptedMill mill_;
  Options options_;
  std::filesystem::path folder_;

 private:
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace axisgate::axisctl
