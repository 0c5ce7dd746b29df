// Forms with one answer of the RPCs that stream from the client, and WaitMotion, over gRPC.
#include <google/protobuf/util/time_util.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "device/link/clock.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using google::protobuf::util::TimeUtil;

class RpcUnary : public RpcTest {
 protected:
  template <class Stub, class Request, class Response>
  static grpc::Status call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                           const Request& request, Response& response) {
    grpc::ClientContext context;
    limit(context);
    return (stub.*method)(&context, request, &response);
  }

  // Starts a jog of axis 1 in the + direction.
  v1::Motion start_jog() {
    v1::StartJogRequest request;
    request.set_device("devices/stage");
    v1::AxisJog& axis = *request.add_axes();
    axis.set_axis("1");
    axis.set_direction(v1::AxisJog::DIRECTION_PLUS);
    v1::StartJogResponse response;
    const grpc::Status status = call(*stage_, &v1::StageService::Stub::StartJog, request, response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.motion();
  }

  grpc::Status keep_jog(const std::string& motion, std::int64_t number, v1::KeepJogResponse& response) {
    v1::KeepJogRequest request;
    request.set_motion(motion);
    request.set_number(number);
    return call(*stage_, &v1::StageService::Stub::KeepJog, request, response);
  }

  v1::Motion wait(const std::string& motion, std::int64_t max_wait_ms) {
    v1::WaitMotionRequest request;
    request.set_motion(motion);
    *request.mutable_max_wait() = TimeUtil::MillisecondsToDuration(max_wait_ms);
    v1::WaitMotionResponse response;
    const grpc::Status status = call(*stage_, &v1::StageService::Stub::WaitMotion, request, response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.motion();
  }
};

TEST_F(RpcUnary, WaitMotionAnswersWithTheOutcome) {
  v1::Motion motion;
  ASSERT_TRUE(move(move_request(1, "0.5"), &motion).ok());
  const v1::Motion ended = wait(motion.name(), 30'000);
  EXPECT_EQ(ended.state(), v1::MOTION_STATE_SUCCEEDED);
  EXPECT_EQ(ended.results(0).command_pulses(), 50'000);
  EXPECT_EQ(wait(motion.name(), 0).state(), v1::MOTION_STATE_SUCCEEDED);
}

TEST_F(RpcUnary, WaitMotionAnswersWithThePresentStateWhenItsTimeIsOver) {
  const v1::Motion jog = start_jog();
  EXPECT_EQ(wait(jog.name(), 1).state(), v1::MOTION_STATE_RUNNING);
  EXPECT_EQ(wait(jog.name(), 30'000).state(), v1::MOTION_STATE_STOPPED);
}

TEST_F(RpcUnary, WaitMotionLeavesItsPlaceWithItsAnswer) {
  v1::Motion motion;
  ASSERT_TRUE(move(move_request(1, "0.01"), &motion).ok());
  for (int round = 0; round <= api::Streams::kStreamsMax; ++round) {
    ASSERT_EQ(wait(motion.name(), 30'000).state(), v1::MOTION_STATE_SUCCEEDED) << round;
  }
}

TEST_F(RpcUnary, WaitMotionNamesWhatThereIsNot) {
  v1::WaitMotionRequest request;
  v1::WaitMotionResponse response;
  request.set_motion("devices/stage/motions/999");
  EXPECT_EQ(reason(call(*stage_, &v1::StageService::Stub::WaitMotion, request, response)), v1::REASON_NOT_FOUND);
  request.set_motion("devices/nowhere/motions/1");
  EXPECT_EQ(reason(call(*stage_, &v1::StageService::Stub::WaitMotion, request, response)), v1::REASON_UNKNOWN_DEVICE);
}

// A jog that is kept outlives the 500 ms of silence that end one; the same number again does not keep it.
TEST_F(RpcUnary, AJogRunsWhileHigherNumbersCome) {
  const v1::Motion jog = start_jog();
  EXPECT_EQ(jog.state(), v1::MOTION_STATE_RUNNING);
  v1::KeepJogResponse kept;
  const TimePoint begun = monotonic_now();
  std::int64_t number = 0;
  while (monotonic_now() - begun < std::chrono::seconds(2)) {
    ASSERT_TRUE(keep_jog(jog.name(), ++number, kept).ok());
    if (!kept.extended()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the caller's own rhythm, well below 500 ms
  }
  ASSERT_TRUE(kept.extended()) << kept.motion().ShortDebugString();
  EXPECT_EQ(kept.motion().state(), v1::MOTION_STATE_RUNNING);
  while (kept.motion().end_time().seconds() == 0) {
    ASSERT_TRUE(keep_jog(jog.name(), number, kept).ok());
    EXPECT_FALSE(kept.extended());
  }
  EXPECT_EQ(kept.motion().state(), v1::MOTION_STATE_STOPPED);
  ASSERT_TRUE(keep_jog(jog.name(), number + 1, kept).ok());
  EXPECT_FALSE(kept.extended());
}

// The caller does not know the motion before it starts, which takes longer here than the silence that ends a jog.
TEST_F(RpcUnary, AJogThatWaitsForItsTurnNeedsNoMessage) {
  v1::MoveRequest slow = move_request(1, "1");
  slow.mutable_targets(0)->mutable_profile()->mutable_minimum()->set_pulses_per_s(2000);
  slow.mutable_targets(0)->mutable_profile()->mutable_maximum()->set_pulses_per_s(2000);
  v1::Motion before;
  ASSERT_TRUE(move(slow, &before).ok());
  const v1::Motion jog = start_jog();
  EXPECT_EQ(jog.state(), v1::MOTION_STATE_RUNNING) << jog.ShortDebugString();
  const v1::Motion moved = motion_now(before.name());
  EXPECT_EQ(moved.state(), v1::MOTION_STATE_SUCCEEDED);
  EXPECT_GT(TimeUtil::TimestampToMilliseconds(moved.end_time()) - TimeUtil::TimestampToMilliseconds(jog.create_time()),
            600);
}

TEST_F(RpcUnary, StopJogLetsTheJogSucceed) {
  const v1::Motion jog = start_jog();
  v1::StopJogRequest request;
  request.set_motion(jog.name());
  v1::StopJogResponse response;
  ASSERT_TRUE(call(*stage_, &v1::StageService::Stub::StopJog, request, response).ok());
  EXPECT_EQ(wait(jog.name(), 30'000).state(), v1::MOTION_STATE_SUCCEEDED);
  ASSERT_TRUE(call(*stage_, &v1::StageService::Stub::StopJog, request, response).ok());
  EXPECT_EQ(response.motion().state(), v1::MOTION_STATE_SUCCEEDED);
}

TEST_F(RpcUnary, AJogIsKeptByNobodyElse) {
  v1::Motion motion;
  ASSERT_TRUE(move(move_request(2, "0.5"), &motion).ok());
  v1::KeepJogResponse kept;
  EXPECT_EQ(reason(keep_jog(motion.name(), 1, kept)), v1::REASON_INVALID_REQUEST);
  const v1::Motion jog = start_jog();
  v1::CreateTokenRequest create;
  create.set_name("other");
  v1::CreateTokenResponse created;
  const auto access = v1::AccessService::NewStub(channel_);
  ASSERT_TRUE(call(*access, &v1::AccessService::Stub::CreateToken, create, created).ok());
  grpc::ClientContext context;
  limit(context);
  context.AddMetadata("authorization", "Bearer " + created.secret());
  v1::KeepJogRequest request;
  request.set_motion(jog.name());
  request.set_number(1);
  EXPECT_EQ(reason(stage_->KeepJog(&context, request, &kept)), v1::REASON_NOT_ALLOWED);
}

TEST_F(RpcUnary, ARefusedMessageStopsTheJog) {
  const v1::Motion jog = start_jog();
  v1::KeepJogRequest request;
  request.set_motion(jog.name());
  request.set_number(1);
  request.add_axes()->set_axis("9");
  v1::KeepJogResponse kept;
  EXPECT_EQ(reason(call(*stage_, &v1::StageService::Stub::KeepJog, request, kept)), v1::REASON_UNKNOWN_AXIS);
  const v1::Motion ended = wait(jog.name(), 30'000);
  EXPECT_EQ(ended.state(), v1::MOTION_STATE_STOPPED);
  EXPECT_EQ(ended.problem().reason(), v1::REASON_UNKNOWN_AXIS);
}

TEST_F(RpcUnary, APathInOneMessageRuns) {
  v1::StartPathRequest request;
  request.set_device("devices/stage");
  for (const char* place : {"10", "20", "30"}) {
    v1::AxisDistance& single = *request.add_segments()->mutable_single();
    single.set_axis("1");
    single.mutable_distance()->set_um(place);
  }
  request.set_validate_only(true);
  v1::StartPathResponse response;
  ASSERT_TRUE(call(*stage_, &v1::StageService::Stub::StartPath, request, response).ok());
  EXPECT_FALSE(response.has_motion());
  request.set_validate_only(false);
  ASSERT_TRUE(call(*stage_, &v1::StageService::Stub::StartPath, request, response).ok());
  const v1::Motion ended = wait(response.motion().name(), 30'000);
  EXPECT_EQ(ended.state(), v1::MOTION_STATE_SUCCEEDED);
  EXPECT_EQ(ended.segments_done(), 3);
  EXPECT_EQ(ended.results(0).command_pulses(), 3'000);
  request.mutable_segments(1)->mutable_single()->set_axis("9");
  const grpc::Status wrong = call(*stage_, &v1::StageService::Stub::StartPath, request, response);
  EXPECT_EQ(reason(wrong), v1::REASON_UNKNOWN_AXIS);
  EXPECT_NE(wrong.error_message().find("segment 2"), std::string::npos) << wrong.error_message();
  while (request.segments_size() <= 10'000) *request.add_segments() = request.segments(0);
  EXPECT_EQ(reason(call(*stage_, &v1::StageService::Stub::StartPath, request, response)), v1::REASON_INVALID_REQUEST);
}

TEST_F(RpcUnary, ALeaseIsRenewedByItsHolder) {
  v1::AcquireLeaseRequest acquire;
  acquire.set_device("devices/stage");
  *acquire.mutable_terms()->mutable_time_to_live() = TimeUtil::SecondsToDuration(60);
  v1::AcquireLeaseResponse acquired;
  ASSERT_TRUE(call(*control_, &v1::ControlService::Stub::AcquireLease, acquire, acquired).ok());
  v1::RenewLeaseRequest renew;
  renew.set_device("devices/stage");
  renew.mutable_context()->set_lease_token(acquired.lease().token());
  v1::RenewLeaseResponse renewed;
  ASSERT_TRUE(call(*control_, &v1::ControlService::Stub::RenewLease, renew, renewed).ok());
  EXPECT_EQ(renewed.lease().token(), acquired.lease().token());
  EXPECT_GT(TimeUtil::TimestampToNanoseconds(renewed.lease().expire_time()),
            TimeUtil::TimestampToNanoseconds(acquired.lease().expire_time()));
  v1::ReleaseLeaseRequest release;
  release.set_device("devices/stage");
  *release.mutable_context() = renew.context();
  v1::ReleaseLeaseResponse released;
  ASSERT_TRUE(call(*control_, &v1::ControlService::Stub::ReleaseLease, release, released).ok());
  EXPECT_EQ(reason(call(*control_, &v1::ControlService::Stub::RenewLease, renew, renewed)), v1::REASON_LEASE_LOST);
  renew.mutable_context()->clear_lease_token();
  EXPECT_EQ(reason(call(*control_, &v1::ControlService::Stub::RenewLease, renew, renewed)), v1::REASON_LEASE_LOST);
}

}  // namespace
}  // namespace axisgate::rpc
