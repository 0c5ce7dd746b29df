#include "tests/axisctl/scripted_mill.h"

#include <google/protobuf/util/time_util.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/verb.h"

namespace axisgate::axisctl {

grpc::Status ScriptedMill::next_status() {
  const grpc::Status status = statuses.front();
  if (statuses.size() > 1) statuses.erase(statuses.begin());
  return status;
}

grpc::Status ScriptedMill::ListDevices(grpc::ServerContext*, const v1::ListDevicesRequest*,
                                       v1::ListDevicesResponse* response) {
  calls.emplace_back("ListDevices");
  *response = there;
  response->set_requests_kept(true);
  response->set_request_memory("since noon");
  return grpc::Status::OK;
}

grpc::Status ScriptedMill::SendJob(grpc::ServerContext*, grpc::ServerReader<v1::SendJobRequest>* reader,
                                   v1::SendJobResponse* response) {
  calls.emplace_back("SendJob");
  sent.clear();
  v1::SendJobRequest message;
  while (reader->Read(&message)) sent.push_back(message);
  if (!mill.jobs().empty()) *response->mutable_job() = mill.jobs(0);
  return next_status();
}

grpc::Status ScriptedMill::GetMill(grpc::ServerContext*, const v1::GetMillRequest* request,
                                   v1::GetMillResponse* response) {
  calls.emplace_back("GetMill");
  devices.push_back(request->device());
  *response->mutable_mill() = mill;
  return grpc::Status::OK;
}

grpc::Status ScriptedMill::WatchMill(grpc::ServerContext* context, const v1::WatchMillRequest* request,
                                     grpc::ServerWriter<v1::WatchMillResponse>* writer) {
  calls.emplace_back("WatchMill");
  devices.push_back(request->device());
  for (const v1::Mill& state : watched) {
    v1::WatchMillResponse response;
    *response.mutable_mill() = state;
    writer->Write(response);
  }
  while (!watch_ends && !context->IsCancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return {grpc::StatusCode::UNAVAILABLE, "the daemon ends"};
}

grpc::Status ScriptedMill::ConfirmJob(grpc::ServerContext*, const v1::ConfirmJobRequest* request,
                                      v1::ConfirmJobResponse* response) {
  calls.emplace_back("ConfirmJob");
  confirmed.push_back(*request);
  *response->mutable_job() = mill.jobs(0);
  return next_status();
}

grpc::Status ScriptedMill::StartJob(grpc::ServerContext*, const v1::StartJobRequest* request,
                                    v1::StartJobResponse* response) {
  calls.emplace_back("StartJob");
  started.push_back(*request);
  if (!mill.jobs().empty()) *response->mutable_job() = mill.jobs(0);
  return next_status();
}

grpc::Status ScriptedMill::PauseJob(grpc::ServerContext*, const v1::PauseJobRequest* request,
                                    v1::PauseJobResponse* response) {
  calls.emplace_back("PauseJob");
  paused.push_back(*request);
  devices.push_back(request->device());
  *response->mutable_running() = mill.running();
  return next_status();
}

grpc::Status ScriptedMill::ResumeJob(grpc::ServerContext*, const v1::ResumeJobRequest* request,
                                     v1::ResumeJobResponse* response) {
  calls.emplace_back("ResumeJob");
  devices.push_back(request->device());
  *response->mutable_running() = mill.running();
  return next_status();
}

grpc::Status ScriptedMill::AbortJob(grpc::ServerContext*, const v1::AbortJobRequest* request,
                                    v1::AbortJobResponse* response) {
  calls.emplace_back("AbortJob");
  devices.push_back(request->device());
  if (mill.has_running()) *response->mutable_running() = mill.running();
  return next_status();
}

grpc::Status ScriptedMill::ContinueJob(grpc::ServerContext*, const v1::ContinueJobRequest* request,
                                       v1::ContinueJobResponse* response) {
  calls.emplace_back("ContinueJob");
  continued.push_back(*request);
  if (mill.jobs_size() > 0) *response->mutable_job() = mill.jobs(0);
  return next_status();
}

grpc::Status ScriptedMill::RepeatJob(grpc::ServerContext*, const v1::RepeatJobRequest* request,
                                     v1::RepeatJobResponse* response) {
  calls.emplace_back("RepeatJob");
  repeated.push_back(*request);
  if (mill.jobs_size() > 0) *response->mutable_job() = mill.jobs(0);
  return next_status();
}

grpc::Status ScriptedMill::CancelJob(grpc::ServerContext*, const v1::CancelJobRequest* request,
                                     v1::CancelJobResponse*) {
  calls.emplace_back("CancelJob");
  jobs.push_back(request->job());
  return next_status();
}

grpc::Status ScriptedMill::CancelJobs(grpc::ServerContext*, const v1::CancelJobsRequest* request,
                                      v1::CancelJobsResponse* response) {
  calls.emplace_back("CancelJobs");
  devices.push_back(request->device());
  cleared.push_back(request->owner());
  for (const v1::Job& job : mill.jobs()) response->add_jobs(job.name());
  return next_status();
}

grpc::Status ScriptedMill::MoveJob(grpc::ServerContext*, const v1::MoveJobRequest* request,
                                   v1::MoveJobResponse* response) {
  calls.emplace_back("MoveJob");
  jobs.push_back(request->job());
  *response->mutable_job() = mill.jobs(0);
  return next_status();
}

grpc::Status ScriptedMill::ReportJobDone(grpc::ServerContext*, const v1::ReportJobDoneRequest* request,
                                         v1::ReportJobDoneResponse*) {
  calls.emplace_back("ReportJobDone");
  jobs.push_back(request->job());
  return next_status();
}

MillVerbs::MillVerbs() {
  std::string name = std::filesystem::temp_directory_path() / "axisgate-mill-XXXXXX";
  EXPECT_NE(::mkdtemp(name.data()), nullptr);
  folder_ = name;
  const std::string address = "unix:" + name + "/socket";
  grpc::ServerBuilder builder;
  builder.AddListeningPort(address, grpc::InsecureServerCredentials());
  builder.RegisterService(static_cast<v1::MillService::Service*>(&mill_));
  builder.RegisterService(static_cast<v1::DeviceService::Service*>(&mill_));
  server_ = builder.BuildAndStart();
  options_.target.address = address;
  options_.device = "devices/mill";
  add_device("stage", "shrc203");
  add_device("mill", "rml1");
  mill_.mill.set_name("devices/mill");
  mill_.mill.set_profile("MDX-20");
  mill_.mill.set_line_open(true);
  mill_.mill.add_tools("T1");
  mill_.mill.add_tools("T2");
}

MillVerbs::~MillVerbs() {
  server_->Shutdown(std::chrono::system_clock::time_point());  // a deadline in the past ends open streams
  std::filesystem::remove_all(folder_);
}

Ended MillVerbs::run(std::string_view words) {
  const std::vector<const Verb*> all = verbs();
  const Verb& verb = **std::ranges::find(all, words, &Verb::words);
  Ended ended;
  ::testing::internal::CaptureStdout();
  try {
    ended.exit_code = verb.run(Session{options_, Connection(options_.target, options_.request_id)});
  } catch (const Failure& failure) {
    ended.exit_code = failure.exit_code;
    ended.reason = failure.reason;
    ended.message = failure.message;
    ended.hint = failure.hint;
  }
  ended.output = ::testing::internal::GetCapturedStdout();
  return ended;
}

void MillVerbs::add_device(const std::string& name, const std::string& kind) {
  v1::Device& device = *mill_.there.add_devices();
  device.set_name("devices/" + name);
  device.set_kind(kind);
  if (kind != "rml1") device.add_axes()->set_number(1);
}

v1::Job& MillVerbs::add_job(v1::JobState state) {
  v1::Job& job = *mill_.mill.add_jobs();
  job.set_name("devices/mill/jobs/" + std::to_string(6 + mill_.mill.jobs_size()));
  job.set_title("frame.rml");
  job.mutable_owner()->set_name("unix anna");
  job.mutable_setup()->set_digest("0123456789");
  job.mutable_setup()->set_profile("MDX-20");
  job.mutable_setup()->set_tool("T1");
  job.set_bytes(30'000);
  *job.mutable_shortest_time() = google::protobuf::util::TimeUtil::SecondsToDuration(600);
  *job.mutable_longest_time() = google::protobuf::util::TimeUtil::SecondsToDuration(1000);
  job.set_state(state);
  job.set_streaming(v1::STREAMING_PACED);
  job.mutable_run_on()->set_at_most(64);
  job.mutable_run_on()->set_mm(13.5);
  *job.mutable_run_on()->mutable_longest_time() = google::protobuf::util::TimeUtil::MillisecondsToDuration(3200);
  return job;
}

}  // namespace axisgate::axisctl
