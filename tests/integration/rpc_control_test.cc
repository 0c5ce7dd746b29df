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
  static v1::AcquireLeaseRequest acquire_request(int axis) {
    v1::AcquireLeaseRequest request;
    request.set_device("devices/stage");
    if (axis != 0) request.mutable_terms()->add_axes(std::to_string(axis));
    return request;
  }
  grpc::Status acquire(const v1::AcquireLeaseRequest& request, v1::Lease* lease = nullptr) {
    grpc::ClientContext context;
    limit(context);
    v1::AcquireLeaseResponse response;
    const grpc::Status status = control_->AcquireLease(&context, request, &response);
    if (lease != nullptr) *lease = response.lease();
    return status;
  }
  grpc::Status release(const std::string& token) {
    grpc::ClientContext context;
    limit(context);
    v1::ReleaseLeaseRequest request;
    request.set_device("devices/stage");
    request.mutable_context()->set_lease_token(token);
    v1::ReleaseLeaseResponse response;
    return control_->ReleaseLease(&context, request, &response);
  }
  // The board as soon as `done` holds for it.
  template <class Done>
  v1::WatchLeasesResponse board(const Done& done) {
    grpc::ClientContext context;
    limit(context);
    v1::WatchLeasesRequest request;
    request.set_device("devices/stage");
    const auto stream = control_->WatchLeases(&context, request);
    v1::WatchLeasesResponse response;
    while (stream->Read(&response) && !done(response)) continue;
    EXPECT_TRUE(done(response)) << response.ShortDebugString();
    context.TryCancel();
    return response;
  }
  using Keeping = grpc::ClientReaderWriter<v1::KeepLeaseAliveRequest, v1::KeepLeaseAliveResponse>;
  static bool keep(Keeping& stream, const std::string& token, v1::KeepLeaseAliveResponse* response) {
    v1::KeepLeaseAliveRequest request;
    request.set_device("devices/stage");
    request.set_lease_token(token);
    return stream.Write(request) && stream.Read(response);
  }
};

TEST_F(ControlTest, ALeaseIsTheHoldersAndItsTokenNobodyElses) {
  v1::Lease lease;
  ASSERT_TRUE(acquire(acquire_request(1), &lease).ok());
  EXPECT_EQ(lease.token().size(), 24u);
  EXPECT_EQ(lease.token().substr(0, 8), std::string("\0\0\0\1\0\0\0\1", 8)) << "generation and number";
  EXPECT_THAT(lease.axes(), ElementsAre(1));
  EXPECT_THAT(lease.holder().name(), HasSubstr("unix"));
  EXPECT_EQ(lease.at_loss(), v1::AT_LOSS_STOP);
  EXPECT_EQ(lease.time_to_live().seconds(), 10);
  const auto shown = board([](const v1::WatchLeasesResponse& response) { return response.leases_size() == 1; });
  EXPECT_EQ(shown.leases(0).token(), "");
  v1::MoveRequest request = move_request(1, "1");
  EXPECT_EQ(reason(move(request)), v1::REASON_LEASE_HELD);
  request.mutable_context()->set_lease_token(lease.token());
  EXPECT_TRUE(move(request).ok());
  EXPECT_TRUE(release(lease.token()).ok());
  EXPECT_EQ(reason(release(lease.token())), v1::REASON_LEASE_LOST);
}

TEST_F(ControlTest, WhatCannotBeIsRefused) {
  EXPECT_EQ(reason(acquire(acquire_request(4))), v1::REASON_UNKNOWN_AXIS);
  v1::AcquireLeaseRequest request = acquire_request(1);
  request.mutable_terms()->mutable_time_to_live()->set_nanos(999'999'999);
  EXPECT_EQ(reason(acquire(request)), v1::REASON_INVALID_REQUEST);
  request.mutable_terms()->mutable_time_to_live()->set_seconds(-1);
  EXPECT_EQ(reason(acquire(request)), v1::REASON_INVALID_REQUEST);
  request = acquire_request(1);
  request.mutable_terms()->set_purpose("two\nlines");
  EXPECT_EQ(reason(acquire(request)), v1::REASON_INVALID_REQUEST);
  request = acquire_request(1);
  request.set_validate_only(true);
  v1::Lease lease;
  EXPECT_TRUE(acquire(request, &lease).ok());
  EXPECT_EQ(lease.token(), "");
}

TEST_F(ControlTest, OneWhoGoesAwayWaitsNoLonger) {
  v1::Lease lease;
  ASSERT_TRUE(acquire(acquire_request(1), &lease).ok());
  grpc::ClientContext context;
  limit(context);
  grpc::Status ended;
  std::thread waiting([&] {
    v1::AcquireLeaseRequest request = acquire_request(1);
    request.mutable_wait()->set_seconds(60);
    v1::AcquireLeaseResponse response;
    ended = control_->AcquireLease(&context, request, &response);
  });
  board([](const v1::WatchLeasesResponse& response) { return response.waiting_size() == 1; });
  context.TryCancel();
  waiting.join();
  EXPECT_EQ(ended.error_code(), grpc::StatusCode::CANCELLED);
  board([](const v1::WatchLeasesResponse& response) { return response.waiting_size() == 0; });
}

TEST_F(ControlTest, AStreamThatIsClosedInOrderTellsNothing) {
  v1::AcquireLeaseRequest request = acquire_request(1);
  request.mutable_terms()->set_at_loss(v1::AT_LOSS_STOP_AND_RELEASE);
  v1::Lease lease;
  ASSERT_TRUE(acquire(request, &lease).ok());
  grpc::ClientContext context;
  limit(context);
  const auto stream = control_->KeepLeaseAlive(&context);
  v1::KeepLeaseAliveResponse response;
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
    v1::AcquireLeaseRequest request = acquire_request(1);
    request.mutable_terms()->set_at_loss(v1::AT_LOSS_STOP_AND_RELEASE);
    v1::Lease lease;
    ASSERT_TRUE(acquire(request, &lease).ok()) << i;
    grpc::ClientContext context;
    limit(context);
    const auto stream = control_->KeepLeaseAlive(&context);
    v1::KeepLeaseAliveResponse response;
    ASSERT_TRUE(keep(*stream, lease.token(), &response));
    if (i % 2 == 1) {
      v1::KeepLeaseAliveRequest again;
      again.set_device("devices/stage");
      again.set_lease_token(lease.token());
      stream->Write(again);  // and its answer is never read
    }
    context.TryCancel();
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::CANCELLED);
    board([](const v1::WatchLeasesResponse& board) { return board.leases_size() == 0; });
  }
}

TEST_F(ControlTest, AnEndedLeaseIsNotKeptAlive) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = control_->KeepLeaseAlive(&context);
  v1::KeepLeaseAliveResponse response;
  EXPECT_FALSE(keep(*stream, std::string(24, 'x'), &response));
  EXPECT_EQ(reason(stream->Finish()), v1::REASON_LEASE_LOST);
}

}  // namespace
}  // namespace axisgate::rpc
