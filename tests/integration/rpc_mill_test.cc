// MillService with the built-in simulator: from a job's bytes to what a person says of the workpiece.
#include <gmock/gmock.h>

#include <filesystem>
#include <set>
#include <string>

#include "axisgate/v1/control.grpc.pb.h"
#include "axisgate/v1/event.grpc.pb.h"
#include "axisgate/v1/mill.grpc.pb.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kMill = "devices/mill";
// Half a second each, above the workpiece. A mill's time is the gateway's: a faster simulator does not shorten it.
std::string vectors(int count) {
  std::string job = "PA;VS15;";
  for (int i = 0; i < count; ++i) job += i % 2 == 0 ? "PU400,400;" : "PU0,400;";
  return job + "PU0,0;!MC0;";
}

class RpcMill : public RpcTest {
 protected:
  void SetUp() override {
    spool_ = *server::spool::Spool::open(directory_ + ".spool", {});
    RpcTest::SetUp();
    stub_ = v1::MillService::NewStub(channel_);
    watch_until([](const v1::Mill& mill) { return mill.line_open(); });
  }
  void TearDown() override {
    RpcTest::TearDown();
    spool_.reset();
    std::filesystem::remove_all(directory_ + ".spool");
  }
  void configure(server::Config& config) override {
    const auto read = server::parse_config(
        "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"" AXISGATE_SOURCE_DIR
        "/deploy/mills/mdx-20.toml\"\nconnection = \"simulated\"\nspeed = 20\ntools = [\"T1\", \"T2\"]\n",
        "test.toml", server::device_kinds());
    ASSERT_TRUE(read) << to_string(read.error().front());
    config.devices.push_back(read->devices.front());
    std::get<server::MillConfig>(config.devices.back().family).station = {station_};
  }

  grpc::Status send(const std::string& job, v1::Job* sent = nullptr, const std::string& tool = "T1",
                    const std::string& id = "") {
    grpc::ClientContext context;
    limit(context);
    v1::SendJobResponse response;
    const auto writer = stub_->SendJob(&context, &response);
    v1::SendJobRequest request;
    request.mutable_context()->set_request_id(id);
    request.set_device(kMill);
    request.set_title("part.rml");
    request.set_tool(tool);
    const std::size_t half = job.size() / 2;
    request.set_data(job.substr(0, half));
    writer->Write(request);
    v1::SendJobRequest rest;
    rest.set_data(job.substr(half));
    writer->Write(rest);
    writer->WritesDone();
    const grpc::Status status = writer->Finish();
    if (sent != nullptr) *sent = response.job();
    return status;
  }
  v1::Job sent(const std::string& job, const std::string& id = "") {
    v1::Job made;
    const grpc::Status status = send(job, &made, "T1", id);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return made;
  }
  template <class Request, class Response>
  grpc::Status ask(grpc::Status (v1::MillService::Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                   const Request& request, Response* response = nullptr) {
    grpc::ClientContext context;
    limit(context);
    Response ignored;
    return (stub_.get()->*method)(&context, request, response == nullptr ? &ignored : response);
  }
  grpc::Status confirm(const v1::Job& job) {
    v1::ConfirmJobRequest request;
    request.set_job(job.name());
    *request.mutable_seen() = job.setup();
    return ask(&v1::MillService::Stub::ConfirmJob, request);
  }
  grpc::Status start(const v1::Job& job, v1::StartJobResponse* response = nullptr) {
    v1::StartJobRequest request;
    request.set_job(job.name());
    return ask(&v1::MillService::Stub::StartJob, request, response);
  }
  v1::Mill now() {
    v1::GetMillRequest request;
    request.set_device(kMill);
    v1::GetMillResponse response;
    EXPECT_TRUE(ask(&v1::MillService::Stub::GetMill, request, &response).ok());
    return response.mill();
  }
  template <class Condition>
  v1::Mill watch_until(Condition condition) {
    grpc::ClientContext context;
    limit(context);
    v1::WatchMillRequest request;
    request.set_device(kMill);
    const auto stream = stub_->WatchMill(&context, request);
    v1::WatchMillResponse response;
    while (stream->Read(&response)) {
      if (condition(response.mill())) break;
    }
    EXPECT_TRUE(condition(response.mill())) << "it did not come to that";
    context.TryCancel();
    return response.mill();
  }
  static auto job_is(const v1::Job& job, v1::JobState state) {
    return [name = job.name(), state](const v1::Mill& mill) {
      for (const v1::Job& one : mill.jobs()) {
        if (one.name() == name) return one.state() == state;
      }
      return false;
    };
  }
  template <class Request, class Response>
  grpc::Status on_mill(grpc::Status (v1::MillService::Stub::*method)(grpc::ClientContext*, const Request&, Response*)) {
    Request request;
    request.set_device(kMill);
    return ask(method, request);
  }

  std::string station_ = "unix";
  std::unique_ptr<v1::MillService::Stub> stub_;
};

TEST_F(RpcMill, AConfirmedJobIsFedAndAPersonSaysDone) {
  const v1::Job job = sent(vectors(2));
  EXPECT_EQ(job.name(), "devices/mill/jobs/1");
  EXPECT_EQ(job.title(), "part.rml");
  EXPECT_EQ(job.state(), v1::JOB_STATE_QUEUED);
  EXPECT_THAT(job.owner(), testing::StartsWith("unix "));
  EXPECT_EQ(job.bytes(), static_cast<std::int64_t>(vectors(2).size()));
  EXPECT_THAT(job.setup().digest(), SizeIs(64));
  EXPECT_GT(job.longest().seconds() + job.longest().nanos(), 0);
  ASSERT_TRUE(confirm(job).ok());
  v1::StartJobResponse started;
  ASSERT_TRUE(start(job, &started).ok());
  EXPECT_EQ(started.job().state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(started.run_on().at_most(), 64);
  watch_until(job_is(job, v1::JOB_STATE_FED));
  v1::ReportJobDoneRequest done;
  done.set_job(job.name());
  EXPECT_TRUE(ask(&v1::MillService::Stub::ReportJobDone, done).ok());
  EXPECT_THAT(now().jobs(), IsEmpty());
}

TEST_F(RpcMill, WithoutAConfirmationItDoesNotStart) {
  const v1::Job job = sent(vectors(6));
  EXPECT_EQ(reason(start(job)), v1::REASON_NOT_ALLOWED);
  v1::Job other = job;
  other.mutable_setup()->set_tool("T2");
  EXPECT_EQ(reason(confirm(other)), v1::REASON_STALE_SETPOINT);
}

TEST_F(RpcMill, AJobWithErrorsIsRefusedWithItsPlace) {
  const grpc::Status status = send("PA;\nPU0,0;\nPX1;\n!MC0;");
  EXPECT_EQ(reason(status), v1::REASON_INVALID_REQUEST);
  EXPECT_THAT(status.error_message(), HasSubstr("line 3"));
  EXPECT_THAT(now().jobs(), IsEmpty());
  EXPECT_EQ(reason(send(vectors(2), nullptr, "T7")), v1::REASON_INVALID_REQUEST);
}

TEST_F(RpcMill, AnAbortEndsTheJobAndVoidsTheNextConfirmation) {
  const v1::Job job = sent(vectors(2000)), second = sent(vectors(4));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  watch_until([](const v1::Mill& mill) { return mill.running().executed_least() > 20; });
  EXPECT_EQ(reason(confirm(second)), v1::REASON_WRONG_MODE);
  const grpc::Status aborted = on_mill(&v1::MillService::Stub::AbortJob);
  ASSERT_TRUE(aborted.ok()) << aborted.error_message();
  const v1::Mill mill = watch_until([](const v1::Mill& it) { return !it.has_running() && it.jobs_size() == 1; });
  EXPECT_EQ(mill.jobs(0).name(), second.name());
  ASSERT_TRUE(confirm(second).ok());
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::AbortJob).ok()) << "it always acts";
  EXPECT_EQ(reason(start(second)), v1::REASON_NOT_ALLOWED);
}

TEST_F(RpcMill, ALeaseKeepsOthersOutAndATakeOverAborts) {
  const auto control = v1::ControlService::NewStub(channel_);
  v1::AcquireLeaseRequest acquire;
  acquire.set_device(kMill);
  v1::AcquireLeaseResponse acquired;
  grpc::ClientContext first;
  limit(first);
  ASSERT_TRUE(control->AcquireLease(&first, acquire, &acquired).ok());
  const v1::Job job = sent(vectors(2000));
  ASSERT_TRUE(confirm(job).ok());
  const grpc::Status refused = start(job);
  EXPECT_EQ(reason(refused), v1::REASON_LEASE_HELD) << refused.error_message();
  v1::StartJobRequest leased;
  leased.set_job(job.name());
  leased.mutable_context()->set_lease_token(acquired.lease().token());
  ASSERT_TRUE(ask(&v1::MillService::Stub::StartJob, leased).ok());
  v1::TakeOverLeaseRequest take;
  take.set_device(kMill);
  v1::TakeOverLeaseResponse taken;
  grpc::ClientContext second;
  limit(second);
  ASSERT_TRUE(control->TakeOverLease(&second, take, &taken).ok());
  EXPECT_THAT(watch_until([](const v1::Mill& it) { return !it.has_running(); }).jobs(), IsEmpty())
      << "it was granted when the job was ABORTED";
}

TEST_F(RpcMill, AStopOfAllDevicesIsTheAbort) {
  const v1::Job job = sent(vectors(2000));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  grpc::ClientContext context;
  limit(context);
  v1::StopResponse response;
  ASSERT_TRUE(stage_->Stop(&context, v1::StopRequest(), &response).ok());
  ASSERT_EQ(response.devices_size(), 2);
  EXPECT_EQ(response.devices(1).device(), kMill);
  EXPECT_EQ(response.devices(1).problem().reason(), v1::REASON_OUTCOME_UNKNOWN);
  EXPECT_THAT(response.devices(1).problem().message(), HasSubstr("the abort was sent"));
  watch_until([](const v1::Mill& mill) { return mill.jobs().empty(); });
}

TEST_F(RpcMill, AStopOfAnAxisIsOfTheOnlyStage) {
  const v1::Job job = sent(vectors(2000));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  grpc::ClientContext context;
  limit(context);
  v1::StopRequest request;
  request.add_axes(1);
  v1::StopResponse response;
  ASSERT_TRUE(stage_->Stop(&context, request, &response).ok());
  ASSERT_EQ(response.devices_size(), 1);
  EXPECT_EQ(response.devices(0).device(), "devices/stage");
  EXPECT_TRUE(now().has_running());
}

TEST_F(RpcMill, ItIsAmongTheDevices) {
  grpc::ClientContext context;
  limit(context);
  v1::ListDevicesResponse there;
  ASSERT_TRUE(devices_->ListDevices(&context, v1::ListDevicesRequest(), &there).ok());
  ASSERT_EQ(there.devices_size(), 2);
  EXPECT_EQ(there.devices(0).kind(), "shrc203");
  const v1::Device& mill = there.devices(1);
  EXPECT_EQ(mill.name(), kMill);
  EXPECT_EQ(mill.kind(), "rml1");
  EXPECT_EQ(mill.link(), v1::LINK_STATE_UP);
  EXPECT_EQ(mill.link_problem(), "");
  EXPECT_EQ(mill.model(), "MDX-20");
  EXPECT_THAT(mill.axes(), IsEmpty());
}

TEST_F(RpcMill, PauseAndResume) {
  const v1::Job job = sent(vectors(6));
  EXPECT_EQ(reason(on_mill(&v1::MillService::Stub::PauseJob)), v1::REASON_WRONG_MODE);
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::PauseJob).ok());
  EXPECT_EQ(now().running().sending(), v1::SENDING_STATE_PAUSED);
  const std::int64_t written = now().running().written();
  watch_until([](const v1::Mill& mill) { return mill.running().executed_least() == mill.running().written(); });
  EXPECT_EQ(now().running().written(), written);
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::ResumeJob).ok());
  watch_until(job_is(job, v1::JOB_STATE_FED));
}

TEST_F(RpcMill, TheSameRequestSendsOneJob) {
  const v1::Job first = sent(vectors(4), "send-1"), again = sent(vectors(4), "send-1");
  EXPECT_EQ(again.name(), first.name());
  EXPECT_THAT(now().jobs(), SizeIs(1));
  EXPECT_EQ(reason(send(vectors(6), nullptr, "T1", "send-1")), v1::REASON_REQUEST_ID_REUSED);
}

TEST_F(RpcMill, AJobIsCancelled) {
  const v1::Job job = sent(vectors(4));
  v1::CancelJobRequest request;
  request.set_job(job.name());
  EXPECT_TRUE(ask(&v1::MillService::Stub::CancelJob, request).ok());
  EXPECT_THAT(now().jobs(), IsEmpty());
  EXPECT_EQ(reason(start(job)), v1::REASON_NOT_FOUND);
  EXPECT_EQ(sent(vectors(4)).name(), "devices/mill/jobs/2") << "no number is given twice";
}

TEST_F(RpcMill, ARequestThatComesAgainIsAnsweredAsTheFirst) {
  const v1::Job job = sent(vectors(4));
  v1::CancelJobRequest request;
  request.mutable_context()->set_request_id("cancel-1");
  request.set_job(job.name());
  EXPECT_TRUE(ask(&v1::MillService::Stub::CancelJob, request).ok());
  EXPECT_TRUE(ask(&v1::MillService::Stub::CancelJob, request).ok());
  request.mutable_context()->set_request_id("cancel-2");
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::CancelJob, request)), v1::REASON_NOT_FOUND);
}

TEST_F(RpcMill, ARepeatOfAStartSaysWhatMayRunOn) {
  const v1::Job job = sent(vectors(2000));
  ASSERT_TRUE(confirm(job).ok());
  v1::StartJobRequest request;
  request.mutable_context()->set_request_id("start-1");
  request.set_job(job.name());
  v1::StartJobResponse first, again;
  ASSERT_TRUE(ask(&v1::MillService::Stub::StartJob, request, &first).ok());
  ASSERT_TRUE(ask(&v1::MillService::Stub::StartJob, request, &again).ok());
  EXPECT_GT(again.run_on().at_most(), 0);
  EXPECT_EQ(again.run_on().at_most(), first.run_on().at_most());
}

TEST_F(RpcMill, AfterItsNotAfterNothingStarts) {
  const v1::Job job = sent(vectors(4));
  ASSERT_TRUE(confirm(job).ok());
  v1::StartJobRequest request;
  request.mutable_context()->mutable_not_after()->set_seconds(1);
  request.set_job(job.name());
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::StartJob, request)), v1::REASON_DEADLINE_PASSED);
  EXPECT_FALSE(now().has_running());
}

TEST_F(RpcMill, WhoWatchesSeesWhatBecomesOfAJob) {
  grpc::ClientContext context;
  limit(context);
  v1::WatchRequest from_now;
  from_now.set_device(kMill);
  const auto stream = v1::EventService::NewStub(channel_)->Watch(&context, from_now);
  stream->WaitForInitialMetadata();
  const v1::Job job = sent(vectors(2000));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::PauseJob).ok());
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::AbortJob).ok());
  std::vector<std::string> seen;
  v1::WatchResponse response;
  while (stream->Read(&response)) {
    const v1::Event& event = response.event();
    EXPECT_EQ(event.device(), kMill);
    if (event.has_stop_requested()) seen.push_back("abort");
    if (!event.has_job()) continue;
    EXPECT_EQ(event.job().job().name(), job.name());
    seen.push_back(event.job().sending() != v1::SENDING_STATE_UNSPECIFIED
                       ? v1::SendingState_Name(event.job().sending())
                       : v1::JobState_Name(event.job().job().state()));
    if (seen.back() == "JOB_STATE_ABORTED") break;
  }
  EXPECT_THAT(seen, testing::ElementsAre("JOB_STATE_QUEUED", "JOB_STATE_CONFIRMED", "JOB_STATE_RUNNING",
                                         "SENDING_STATE_SENDING", "SENDING_STATE_PAUSED", "abort",
                                         "SENDING_STATE_ABORTING", "JOB_STATE_ABORTED"));
  EXPECT_THAT(response.event().job().who(), testing::StartsWith("unix "));
  context.TryCancel();
}

TEST_F(RpcMill, AStepByHandVoidsAConfirmationAndIsDoneOnce) {
  const v1::Job job = sent(vectors(4));
  ASSERT_TRUE(confirm(job).ok());
  v1::OperateMillRequest request;
  request.set_device(kMill);
  request.mutable_context()->set_request_id("step-1");
  request.mutable_step()->set_x_mm(5);
  v1::OperateMillResponse first, again;
  ASSERT_TRUE(ask(&v1::MillService::Stub::OperateMill, request, &first).ok());
  EXPECT_GT(first.longest().seconds(), 0);
  ASSERT_TRUE(ask(&v1::MillService::Stub::OperateMill, request, &again).ok()) << "the answer of the first";
  EXPECT_EQ(again.longest().seconds(), first.longest().seconds());
  EXPECT_EQ(reason(start(job)), v1::REASON_NOT_ALLOWED);
  v1::OperateMillRequest named;
  named.set_device(kMill);
  named.mutable_surface()->set_origin("vice");
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::OperateMill, named)), v1::REASON_INVALID_REQUEST);
  named.clear_act();
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::OperateMill, named)), v1::REASON_INVALID_REQUEST);
}

TEST_F(RpcMill, AMillHasNoAxesAndAStageNoJobs) {
  v1::MoveRequest request = move_request(1, "1");
  request.set_device(kMill);
  EXPECT_EQ(reason(move(request)), v1::REASON_INVALID_REQUEST);
  v1::GetMillRequest mill;
  mill.set_device("devices/stage");
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::GetMill, mill)), v1::REASON_INVALID_REQUEST);
}

class RpcMillElsewhere : public RpcMill {
 protected:
  RpcMillElsewhere() { station_ = "cert workshop"; }
};

TEST_F(RpcMillElsewhere, OnlySomebodyAtTheStationConfirms) {
  const v1::Job job = sent(vectors(4));
  const grpc::Status status = confirm(job);
  EXPECT_EQ(reason(status), v1::REASON_NOT_ALLOWED);
  EXPECT_THAT(status.error_message(), HasSubstr("cert workshop"));
}

}  // namespace
}  // namespace axisgate::rpc
