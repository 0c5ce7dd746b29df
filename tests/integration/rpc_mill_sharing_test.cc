// A mill that people share: leases, stops, the station, what others see, acts by hand, and requests that come again.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "axisgate/v1/control.grpc.pb.h"
#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/event.grpc.pb.h"
#include "tests/integration/rpc_mill_fixture.h"

namespace axisgate::rpc {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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

TEST_F(RpcMill, IsLeasedAsAWhole) {
  const auto control = v1::ControlService::NewStub(channel_);
  v1::AcquireLeaseRequest acquire;
  acquire.set_device(kMill);
  acquire.mutable_terms()->add_axes("1");
  acquire.mutable_terms()->add_axes("2");
  v1::AcquireLeaseResponse acquired;
  grpc::ClientContext first;
  limit(first);
  const grpc::Status refused = control->AcquireLease(&first, acquire, &acquired);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(refused.error_message(), HasSubstr("mill has no axes that could be leased one by one"));
  acquire.mutable_terms()->clear_axes();
  grpc::ClientContext second;
  limit(second);
  ASSERT_TRUE(control->AcquireLease(&second, acquire, &acquired).ok());
  EXPECT_TRUE(acquired.lease().whole_device());
  EXPECT_THAT(acquired.lease().axes(), IsEmpty());
  grpc::ClientContext third;
  limit(third);
  const auto board = control->WatchLeases(&third, [] {
    v1::WatchLeasesRequest request;
    request.set_device(kMill);
    return request;
  }());
  v1::WatchLeasesResponse seen;
  ASSERT_TRUE(board->Read(&seen));
  ASSERT_THAT(seen.leases(), SizeIs(1));
  EXPECT_TRUE(seen.leases(0).whole_device());
  third.TryCancel();
}

TEST_F(RpcMill, GetDeviceAnswersForAMill) {
  const auto devices = v1::DeviceService::NewStub(channel_);
  grpc::ClientContext listing;
  limit(listing);
  v1::ListDevicesResponse listed;
  ASSERT_TRUE(devices->ListDevices(&listing, {}, &listed).ok());
  ASSERT_THAT(listed.devices(), SizeIs(2));
  for (const v1::Device& device : listed.devices()) {
    grpc::ClientContext context;
    limit(context);
    v1::GetDeviceRequest request;
    request.set_device(device.name());
    v1::GetDeviceResponse got;
    ASSERT_TRUE(devices->GetDevice(&context, request, &got).ok()) << device.name();
    EXPECT_EQ(got.device().name(), device.name());
    EXPECT_EQ(got.device().kind(), device.kind());
    EXPECT_EQ(got.device().model(), device.model());
  }
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

TEST_F(RpcMill, TheSameRequestSendsOneJob) {
  const v1::Job first = sent(vectors(4), "send-1"), again = sent(vectors(4), "send-1");
  EXPECT_EQ(again.name(), first.name());
  EXPECT_THAT(now().jobs(), SizeIs(1));
  EXPECT_EQ(reason(send(vectors(6), nullptr, "T1", "send-1")), v1::REASON_REQUEST_ID_REUSED);
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

TEST_F(RpcMill, AnAdministratorTakesTheWaitingJobsOfACallerOutOfTheQueue) {
  const v1::Job running = sent(vectors(2000)), second = sent(vectors(4)), third = sent(vectors(4));
  ASSERT_TRUE(confirm(running).ok());
  ASSERT_TRUE(start(running).ok());
  v1::CancelJobsRequest request;
  request.mutable_context()->set_request_id("clear-1");
  request.set_device(kMill);
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::CancelJobs, request)), v1::REASON_INVALID_REQUEST) << "of nobody";
  request.mutable_context()->set_request_id("clear-2");
  request.set_owner("unix nobody of that name");
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::CancelJobs, request)), v1::REASON_NOT_FOUND);
  request.mutable_context()->set_request_id("clear-3");
  request.set_owner(running.owner().name());
  for (const char* time : {"first", "again"}) {
    v1::CancelJobsResponse response;
    ASSERT_TRUE(ask(&v1::MillService::Stub::CancelJobs, request, &response).ok()) << time;
    EXPECT_THAT(response.jobs(), testing::ElementsAre(second.name(), third.name())) << time;
  }
  const v1::Mill mill = now();
  ASSERT_THAT(mill.jobs(), SizeIs(1));
  EXPECT_EQ(mill.jobs(0).name(), running.name());
  EXPECT_TRUE(mill.has_running());
  request.mutable_context()->set_request_id("clear-4");
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::CancelJobs, request)), v1::REASON_NOT_FOUND) << "it runs";
}

// A kill, or the next job that is sent, then finds the new state.
TEST_F(RpcMill, TheSpoolHasWhatBecameOfAJobBeforeTheAnswer) {
  const v1::Job first = sent(vectors(4)), second = sent(vectors(4));
  v1::MoveJobRequest move;
  move.set_job(second.name());
  ASSERT_TRUE(ask(&v1::MillService::Stub::MoveJob, move).ok());
  EXPECT_THAT(spool_->list("mill").at(1).facts, HasSubstr("\"rank\":-1"));
  v1::CancelJobRequest cancel;
  cancel.set_job(first.name());
  ASSERT_TRUE(ask(&v1::MillService::Stub::CancelJob, cancel).ok());
  EXPECT_TRUE(spool_->list("mill").at(0).ended);
  v1::CancelJobsRequest clear;
  clear.set_device(kMill);
  clear.set_owner(second.owner().name());
  ASSERT_TRUE(ask(&v1::MillService::Stub::CancelJobs, clear).ok());
  EXPECT_TRUE(spool_->list("mill").at(1).ended);
}

TEST_F(RpcMill, AJobIsMovedToTheFrontOnce) {
  const v1::Job first = sent(vectors(4)), second = sent(vectors(4)), third = sent(vectors(4));
  const auto order = [this] {
    std::vector<std::string> names;
    const v1::Mill mill = now();
    for (const v1::Job& job : mill.jobs()) names.push_back(job.name());
    return names;
  };
  const auto moved = [this](const std::string& job, const std::string& id, v1::MoveJobResponse* response = nullptr) {
    v1::MoveJobRequest request;
    request.mutable_context()->set_request_id(id);
    request.set_job(job);
    return reason(ask(&v1::MillService::Stub::MoveJob, request, response));
  };
  v1::MoveJobResponse response;
  ASSERT_EQ(moved(third.name(), "move-1", &response), v1::REASON_UNSPECIFIED);
  EXPECT_EQ(response.job().name(), third.name());
  EXPECT_THAT(order(), testing::ElementsAre(third.name(), first.name(), second.name()));
  ASSERT_EQ(moved(second.name(), "move-2"), v1::REASON_UNSPECIFIED);
  ASSERT_EQ(moved(third.name(), "move-1", &response), v1::REASON_UNSPECIFIED) << "it came before";
  EXPECT_EQ(response.job().name(), third.name());
  EXPECT_THAT(order(), testing::ElementsAre(second.name(), third.name(), first.name()));
  EXPECT_EQ(reason(confirm(third)), v1::REASON_WRONG_JOB_STATE);
  ASSERT_TRUE(confirm(second).ok());
  EXPECT_EQ(moved(second.name(), "move-3"), v1::REASON_WRONG_JOB_STATE);
  EXPECT_EQ(moved("devices/mill/jobs/99", "move-4"), v1::REASON_NOT_FOUND);
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
  EXPECT_EQ(again.run_on().longest_time().nanos(), first.run_on().longest_time().nanos());
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
  EXPECT_THAT(response.event().job().caller().name(), testing::StartsWith("unix "));
  context.TryCancel();
}

TEST_F(RpcMill, AStepByHandVoidsAConfirmationAndIsDoneOnce) {
  const v1::Job job = sent(vectors(4));
  ASSERT_TRUE(confirm(job).ok());
  v1::OperateMillRequest request;
  request.set_device(kMill);
  request.mutable_context()->set_request_id("step-1");
  request.mutable_step()->mutable_x()->set_mm("5");
  v1::OperateMillResponse first, again;
  ASSERT_TRUE(ask(&v1::MillService::Stub::OperateMill, request, &first).ok());
  EXPECT_GT(first.longest_time().seconds(), 0);
  ASSERT_TRUE(ask(&v1::MillService::Stub::OperateMill, request, &again).ok()) << "the answer of the first";
  EXPECT_EQ(again.longest_time().seconds(), first.longest_time().seconds());
  EXPECT_EQ(reason(start(job)), v1::REASON_NOT_CONFIRMED);
  v1::OperateMillRequest named;
  named.set_device(kMill);
  named.mutable_surface()->set_origin("vice");
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::OperateMill, named)), v1::REASON_INVALID_REQUEST);
  named.clear_act();
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::OperateMill, named)), v1::REASON_INVALID_REQUEST);
}

class RpcMillWithOrigin : public RpcMill {
 protected:
  void configure(server::Config& config) override {
    RpcMill::configure(config);
    std::get<server::MillConfig>(config.devices.back().family).origins = {{.name = "vice", .z = -800}};
  }
};

TEST_F(RpcMillWithOrigin, Z0IsAtAnOriginOrAtAHeightAndNotAtBoth) {
  v1::OperateMillRequest request;
  request.set_device(kMill);
  request.mutable_surface()->set_origin("vice");
  request.mutable_surface()->mutable_z()->set_pulses(-40);
  const grpc::Status both = ask(&v1::MillService::Stub::OperateMill, request);
  EXPECT_EQ(reason(both), v1::REASON_INVALID_REQUEST);
  EXPECT_THAT(both.error_message(), HasSubstr("both at the origin \"vice\" and at a coordinate"));
  request.mutable_surface()->clear_z();
  EXPECT_TRUE(ask(&v1::MillService::Stub::OperateMill, request).ok());
  request.mutable_surface()->clear_origin();
  request.mutable_surface()->mutable_z()->set_pulses(0);
  EXPECT_TRUE(ask(&v1::MillService::Stub::OperateMill, request).ok());
}

class RpcMillElsewhere : public RpcMill {
 protected:
  RpcMillElsewhere() { station_ = "cert workshop"; }
};

TEST_F(RpcMillElsewhere, OnlySomebodyAtTheStationConfirms) {
  const v1::Job job = sent(vectors(4));
  const grpc::Status status = confirm(job);
  EXPECT_EQ(reason(status), v1::REASON_NOT_ALLOWED);
  EXPECT_THAT(problem(status).hint(), HasSubstr("cert workshop"));
}

}  // namespace
}  // namespace axisgate::rpc
