// Tests of sessions: a program is recognised by its connection, or by its `axisgate-session`.
#include <gmock/gmock.h>

#include <memory>
#include <string>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

class SessionTest : public RpcTest {
 protected:
  // A connection of its own, whose callers have no name.
  std::shared_ptr<grpc::Channel> tcp() const {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel(to_string(doors_->listen()), grpc::InsecureChannelCredentials(), arguments);
  }

  static void prepare(grpc::ClientContext& context, const std::string& session) {
    limit(context);
    if (!session.empty()) context.AddMetadata("axisgate-session", session);
  }

  // Until its outcome.
  v1::Reason moved(const std::shared_ptr<grpc::Channel>& channel, const std::string& session) {
    grpc::ClientContext context;
    prepare(context, session);
    v1::MoveResponse response;
    const grpc::Status status = v1::StageService::NewStub(channel)->Move(&context, move_request(1, "0.01"), &response);
    if (status.ok()) outcome(response.motion().name());
    return reason(status);
  }

  static void stop(const std::shared_ptr<grpc::Channel>& channel, const std::string& session) {
    grpc::ClientContext context;
    prepare(context, session);
    v1::StopResponse response;
    EXPECT_TRUE(v1::StageService::NewStub(channel)->Stop(&context, {}, &response).ok());
  }

  static void rearm(const std::shared_ptr<grpc::Channel>& channel) {
    grpc::ClientContext context;
    limit(context);
    v1::RearmRequest request;
    request.set_device("devices/stage");
    v1::RearmResponse response;
    EXPECT_TRUE(v1::ControlService::NewStub(channel)->Rearm(&context, request, &response).ok());
  }
};

TEST_F(SessionTest, AStopOverTheSameConnectionHoldsNobodyBack) {
  const auto one = tcp(), other = tcp();
  EXPECT_EQ(moved(one, ""), v1::REASON_UNSPECIFIED);
  stop(one, "");
  EXPECT_EQ(moved(one, ""), v1::REASON_UNSPECIFIED);
  stop(other, "");
  EXPECT_EQ(moved(one, ""), v1::REASON_STOPPED_BY);
}

TEST_F(SessionTest, AStopWithTheSameSessionHoldsNobodyBack) {
  const auto one = tcp(), other = tcp();
  const std::string session = "0f9d2c71-5b1e-4c83";
  EXPECT_EQ(moved(one, session), v1::REASON_UNSPECIFIED);
  stop(other, session);
  EXPECT_EQ(moved(one, session), v1::REASON_UNSPECIFIED);
  stop(other, "another-program");
  EXPECT_EQ(moved(one, session), v1::REASON_STOPPED_BY);
  rearm(one);
  EXPECT_EQ(moved(one, "short"), v1::REASON_UNSPECIFIED);
  stop(other, "short");
  EXPECT_EQ(moved(one, "short"), v1::REASON_STOPPED_BY) << "what is no session names no program";
}

}  // namespace
}  // namespace axisgate::rpc
