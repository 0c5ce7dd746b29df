// Tests of SendJobPiece: jobs that arrive in pieces, one call each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/integration/rpc_mill_fixture.h"

namespace axisgate::rpc {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class RpcJobPieces : public RpcMill {
 protected:
  v1::SendJobPieceResponse piece(std::int64_t offset, const std::string& data, bool last = false) {
    v1::SendJobPieceResponse response;
    const grpc::Status status = try_piece(offset, data, last, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response;
  }
  grpc::Status try_piece(std::int64_t offset, const std::string& data, bool last,
                         v1::SendJobPieceResponse* response = nullptr) {
    v1::SendJobPieceRequest request;
    *request.mutable_header() = header_;
    request.set_offset(offset);
    request.set_data(data);
    request.set_last(last);
    return ask(&v1::MillService::Stub::SendJobPiece, request, response);
  }

  const std::string job_ = vectors(20);
  const std::int64_t bytes_ = static_cast<std::int64_t>(job_.size());
  v1::JobHeader header_ = header_of("in-pieces-1");
};

TEST_F(RpcJobPieces, TheLastPieceQueuesTheJob) {
  EXPECT_EQ(piece(0, job_.substr(0, 10)).received(), 10);
  EXPECT_THAT(now().jobs(), IsEmpty());
  const v1::SendJobPieceResponse last = piece(10, job_.substr(10), true);
  EXPECT_EQ(last.received(), bytes_);
  EXPECT_EQ(last.job().state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(last.job().setup().digest(), sent(job_).setup().digest()) << "SendJob queues the same bytes";
}

TEST_F(RpcJobPieces, LateAndRepeatedPiecesChangeNothing) {
  piece(0, job_.substr(0, 10));
  EXPECT_EQ(piece(0, job_.substr(0, 10)).received(), 10);
  EXPECT_EQ(piece(30, job_.substr(30), true).received(), 10) << "a piece between is missing";
  const std::string name = piece(10, job_.substr(10), true).job().name();
  EXPECT_EQ(piece(10, job_.substr(10), true).job().name(), name);
  EXPECT_EQ(now().jobs_size(), 1);
}

TEST_F(RpcJobPieces, AnUnknownJobBeginsAtZero) { EXPECT_EQ(piece(10, "PU;").received(), 0); }

TEST_F(RpcJobPieces, AJobThatWasStreamedBeforeIsQueuedOnce) {
  const std::string name = sent(job_, "in-pieces-1").name();
  EXPECT_EQ(piece(0, job_, true).job().name(), name);
  EXPECT_EQ(now().jobs_size(), 1);
}

TEST_F(RpcJobPieces, AFaultyJobIsDropped) {
  const grpc::Status faulty = try_piece(0, "PA;\nPX1;\n", true);
  EXPECT_EQ(reason(faulty), v1::REASON_INVALID_REQUEST);
  EXPECT_THAT(faulty.error_message(), HasSubstr("line 2"));
  EXPECT_EQ(piece(5, "PU;").received(), 0);
  EXPECT_EQ(piece(0, job_, true).job().state(), v1::JOB_STATE_QUEUED);
}

TEST_F(RpcJobPieces, TheHeaderStaysTheSame) {
  piece(0, job_.substr(0, 10));
  header_.set_title("other.rml");
  EXPECT_EQ(reason(try_piece(10, job_.substr(10), true)), v1::REASON_REQUEST_ID_REUSED);
}

TEST_F(RpcJobPieces, ARequestIdAndSmallPiecesAreNeeded) {
  EXPECT_EQ(reason(try_piece(0, std::string((1 << 20) + 1, ';'), false)), v1::REASON_INVALID_REQUEST);
  header_.mutable_context()->clear_request_id();
  EXPECT_EQ(reason(try_piece(0, "PU;", false)), v1::REASON_INVALID_REQUEST);
}

// A caller over loopback without a credential has another port with each connection.
TEST_F(RpcJobPieces, PiecesMayComeOverSeveralConnections) {
  v1::SendJobPieceRequest request;
  *request.mutable_header() = header_;
  request.set_data(job_.substr(0, 10));
  for (const std::int64_t received : {std::int64_t{10}, bytes_}) {
    grpc::ChannelArguments own_connection;
    own_connection.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    const auto channel =
        grpc::CreateCustomChannel(to_string(doors_->listen()), grpc::InsecureChannelCredentials(), own_connection);
    grpc::ClientContext context;
    limit(context);
    v1::SendJobPieceResponse response;
    const grpc::Status status = v1::MillService::NewStub(channel)->SendJobPiece(&context, request, &response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(response.received(), received);
    request.set_offset(10);
    request.set_data(job_.substr(10));
    request.set_last(true);
  }
  EXPECT_EQ(now().jobs_size(), 1);
}

TEST_F(RpcJobPieces, ACallerHasFourUnfinishedJobs) {
  for (const char* id : {"1", "2", "3", "4"}) {
    header_.mutable_context()->set_request_id(id);
    piece(0, "PU;");
  }
  header_.mutable_context()->set_request_id("5");
  EXPECT_EQ(reason(try_piece(0, "PU;", false)), v1::REASON_QUEUE_FULL);
  header_.mutable_context()->set_request_id("1");
  EXPECT_EQ(piece(3, job_, true).job().state(), v1::JOB_STATE_QUEUED);
  header_.mutable_context()->set_request_id("5");
  EXPECT_EQ(piece(0, "PU;").received(), 3);
}

}  // namespace
}  // namespace axisgate::rpc
