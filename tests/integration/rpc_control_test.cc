// ControlService: what its streams and cancelled calls come to. What leases do is in tests/unit and tests/simulation.
#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ControlTest : public RpcTest {
 protected:
  static api::AcquireLeaseRequest acquire_request(int axis) {
    api::AcquireLeaseRequest request;
    request.set_device("devices/stage");
    if (axis != 0) request.mutable_terms()->add_axes(axis);
    return request;
  }
  grpc::Status acquire(const api::AcquireLeaseRequest& request, api::Lease* lease = nullptr) {
    grpc::ClientContext context;
    limit(context);
    api::AcquireLeaseResponse response;
    const grpc::Status status = control_->AcquireLease(&context, request, &response);
    if (lease != nullptr) *lease = response.lease();
    return status;
  }
  grpc::Status release(std::uint64_t token) {
    grpc::ClientContext context;
    limit(context);
    api::ReleaseLeaseRequest request;
    request.set_device("devices/stage");
    request.mutable_context()->set_lease_token(token);
    api::ReleaseLeaseResponse response;
    return control_->ReleaseLease(&context, request, &response);
  }
  // The board as soon as `done` holds for it.
  template <class Done>
  api::WatchLeasesResponse board(const Done& done) {
    grpc::ClientContext context;
    limit(context);
    api::WatchLeasesRequest request;
    request.set_device("devices/stage");
    const auto stream = control_->WatchLeases(&context, request);
    api::WatchLeasesResponse response;
    while (stream->Read(&response) && !done(response)) continue;
    EXPECT_TRUE(done(response)) << response.ShortDebugString();
    context.TryCancel();
    return response;
  }
  using Keeping = grpc::ClientReaderWriter<api::KeepLeaseAliveRequest, api::KeepLeaseAliveResponse>;
  static bool keep(Keeping& stream, std::uint64_t token, api::KeepLeaseAliveResponse* response) {
    api::KeepLeaseAliveRequest request;
    request.set_device("devices/stage");
    request.set_lease_token(token);
    return stream.Write(request) && stream.Read(response);
  }
};

TEST_F(ControlTest, ALeaseIsTheHoldersAndItsTokenNobodyElses) {
  api::Lease lease;
  ASSERT_TRUE(acquire(acquire_request(1), &lease).ok());
  EXPECT_EQ(lease.token() >> 32, 1u);
  EXPECT_THAT(lease.axes(), ElementsAre(1));
  EXPECT_THAT(lease.holder(), HasSubstr("unix"));
  EXPECT_EQ(lease.at_loss(), api::AT_LOSS_STOP);
  EXPECT_EQ(lease.time_to_live().seconds(), 10);
  const auto shown = board([](const api::WatchLeasesResponse& response) { return response.leases_size() == 1; });
  EXPECT_EQ(shown.leases(0).token(), 0u);
  api::MoveRequest request = move_request(1, "1");
  EXPECT_EQ(reason(move(request)), api::REASON_LEASE_HELD);
  request.mutable_context()->set_lease_token(lease.token());
  EXPECT_TRUE(move(request).ok());
  EXPECT_TRUE(release(lease.token()).ok());
  EXPECT_EQ(reason(release(lease.token())), api::REASON_LEASE_LOST);
}

TEST_F(ControlTest, WhatCannotBeIsRefused) {
  EXPECT_EQ(reason(acquire(acquire_request(4))), api::REASON_UNKNOWN_AXIS);
  api::AcquireLeaseRequest request = acquire_request(1);
  request.mutable_terms()->mutable_time_to_live()->set_nanos(999'999'999);
  EXPECT_EQ(reason(acquire(request)), api::REASON_INVALID_REQUEST);
  request.mutable_terms()->mutable_time_to_live()->set_seconds(-1);
  EXPECT_EQ(reason(acquire(request)), api::REASON_INVALID_REQUEST);
  request = acquire_request(1);
  request.mutable_terms()->set_purpose("two\nlines");
  EXPECT_EQ(reason(acquire(request)), api::REASON_INVALID_REQUEST);
  request = acquire_request(1);
  request.set_validate_only(true);
  api::Lease lease;
  EXPECT_TRUE(acquire(request, &lease).ok());
  EXPECT_EQ(lease.token(), 0u);
}

TEST_F(ControlTest, OneWhoGoesAwayWaitsNoLonger) {
  api::Lease lease;
  ASSERT_TRUE(acquire(acquire_request(1), &lease).ok());
  grpc::ClientContext context;
  limit(context);
  grpc::Status ended;
  std::thread waiting([&] {
    api::AcquireLeaseRequest request = acquire_request(1);
    request.mutable_wait()->set_seconds(60);
    api::AcquireLeaseResponse response;
    ended = control_->AcquireLease(&context, request, &response);
  });
  board([](const api::WatchLeasesResponse& response) { return response.waiting_size() == 1; });
  context.TryCancel();
  waiting.join();
  EXPECT_EQ(ended.error_code(), grpc::StatusCode::CANCELLED);
  board([](const api::WatchLeasesResponse& response) { return response.waiting_size() == 0; });
}

TEST_F(ControlTest, AStreamThatIsClosedInOrderTellsNothing) {
  api::AcquireLeaseRequest request = acquire_request(1);
  request.mutable_terms()->set_at_loss(api::AT_LOSS_STOP_AND_RELEASE);
  api::Lease lease;
  ASSERT_TRUE(acquire(request, &lease).ok());
  grpc::ClientContext context;
  limit(context);
  const auto stream = control_->KeepLeaseAlive(&context);
  api::KeepLeaseAliveResponse response;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(keep(*stream, lease.token(), &response));
  EXPECT_EQ(response.lease().token(), lease.token());
  stream->WritesDone();
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_TRUE(release(lease.token()).ok());
}

// Again and again, in all phases of the stream.
TEST_F(ControlTest, AStreamThatBreaksOffEndsTheLease) {
  for (int i = 0; i < 100; ++i) {
    api::AcquireLeaseRequest request = acquire_request(1);
    request.mutable_terms()->set_at_loss(api::AT_LOSS_STOP_AND_RELEASE);
    api::Lease lease;
    ASSERT_TRUE(acquire(request, &lease).ok()) << i;
    grpc::ClientContext context;
    limit(context);
    const auto stream = control_->KeepLeaseAlive(&context);
    api::KeepLeaseAliveResponse response;
    ASSERT_TRUE(keep(*stream, lease.token(), &response));
    if (i % 2 == 1) {
      api::KeepLeaseAliveRequest again;
      again.set_device("devices/stage");
      again.set_lease_token(lease.token());
      stream->Write(again);  // and its answer is never read
    }
    context.TryCancel();
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::CANCELLED);
    board([](const api::WatchLeasesResponse& board) { return board.leases_size() == 0; });
  }
}

TEST_F(ControlTest, AnEndedLeaseIsNotKeptAlive) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = control_->KeepLeaseAlive(&context);
  api::KeepLeaseAliveResponse response;
  EXPECT_FALSE(keep(*stream, 12345, &response));
  EXPECT_EQ(reason(stream->Finish()), api::REASON_LEASE_LOST);
}

}  // namespace
}  // namespace axisgate::rpc
