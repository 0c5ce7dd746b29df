// Scripted daemon with a stage and one mill, and a fixture that runs axisctl's verbs on it, all within the process of
// the test.
#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/mill.grpc.pb.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// A ScriptedMill answers as the test has set, and records all requests. Each vector of answers is used from its front;
// the last answer is repeated.
class ScriptedMill : public v1::MillService::Service, public v1::DeviceService::Service {
 public:
  std::vector<grpc::Status> statuses{grpc::Status::OK};  // answers of mutations
  v1::Mill mill;
  v1::ListDevicesResponse there;
  std::vector<v1::Mill> watched;  // after these the stream stays open, unless watch_ends
  bool watch_ends = false;

  std::vector<std::string> calls;  // names of the calls in order, such as "SendJob"
  std::vector<v1::SendJobRequest> sent;
  std::vector<v1::ConfirmJobRequest> confirmed;
  std::vector<v1::StartJobRequest> started;
  std::vector<v1::PauseJobRequest> paused;
  std::vector<v1::ContinueJobRequest> continued;
  std::vector<v1::RepeatJobRequest> repeated;
  std::vector<std::string> cleared;        // owners of the cleared jobs
  std::vector<std::string> devices, jobs;  // names in the other requests

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

// Result of a verb, as main() would report it.
struct Ended {
  int exit_code = 0;
  std::string output, reason, message, hint;  // reason, message, hint: empty without a Failure
};

class MillVerbs : public ::testing::Test {
 protected:
  MillVerbs();
  ~MillVerbs() override;

  // Runs the verb with these words, such as "mill send".
  Ended run(std::string_view words);

  // Adds a device to the daemon's list.
  void add_device(const std::string& name, const std::string& kind);
  // Adds a job of 30,000 bytes. Jobs are numbered 7, 8, ...
  v1::Job& add_job(v1::JobState state);

  ScriptedMill mill_;
  Options options_;
  std::filesystem::path folder_;

 private:
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace axisgate::axisctl
