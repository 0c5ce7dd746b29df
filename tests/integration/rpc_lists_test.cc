// Pages and filters of lists, capabilities, and the motion of a transaction, over gRPC.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "axisgate/v1/event.grpc.pb.h"
#include "axisgate/v1/position.grpc.pb.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kWritten = 1'795'824'000;  // 2026-11-28, before any run of this test

class RpcLists : public RpcTest {
 protected:
  v1::ListMotionsResponse motions(v1::ListMotionsRequest request) {
    request.set_device("devices/stage");
    grpc::ClientContext context;
    limit(context);
    v1::ListMotionsResponse response;
    EXPECT_TRUE(stage_->ListMotions(&context, request, &response).ok());
    return response;
  }
  // The last parts of the motions' names.
  static std::vector<std::string> ids(const v1::ListMotionsResponse& response) {
    std::vector<std::string> ids;
    for (const v1::Motion& motion : response.motions())
      ids.push_back(motion.name().substr(motion.name().rfind('/') + 1));
    return ids;
  }
};

TEST_F(RpcLists, MotionsComeInPagesNewestFirst) {
  for (int round = 0; round < 5; ++round) {
    v1::Motion motion;
    ASSERT_TRUE(move(move_request(1, "0.0" + std::to_string(round + 1)), &motion).ok());
    outcome(motion.name());
  }
  v1::ListMotionsRequest request;
  request.set_page_size(2);
  v1::ListMotionsResponse page = motions(request);
  EXPECT_THAT(ids(page), ElementsAre("5", "4"));
  v1::Motion newer;
  ASSERT_TRUE(move(move_request(1, "0.09"), &newer).ok());  // it does not shift the later pages
  request.set_page_token(page.next_page_token());
  page = motions(request);
  EXPECT_THAT(ids(page), ElementsAre("3", "2"));
  request.set_page_token(page.next_page_token());
  page = motions(request);
  EXPECT_THAT(ids(page), ElementsAre("1"));
  EXPECT_EQ(page.next_page_token(), "");
  EXPECT_EQ(outcome(newer.name()).state(), v1::MOTION_STATE_SUCCEEDED);
  v1::ListMotionsRequest failed;
  failed.add_states(v1::MOTION_STATE_FAILED);
  EXPECT_THAT(ids(motions(failed)), IsEmpty());
  failed.add_states(v1::MOTION_STATE_SUCCEEDED);
  EXPECT_EQ(motions(failed).motions_size(), 6);
}

TEST_F(RpcLists, APageHasASizeThatThereIs) {
  v1::ListMotionsRequest request;
  request.set_device("devices/stage");
  for (const int size : {-1, 1001}) {
    request.set_page_size(size);
    grpc::ClientContext context;
    limit(context);
    v1::ListMotionsResponse response;
    EXPECT_EQ(reason(stage_->ListMotions(&context, request, &response)), v1::REASON_INVALID_REQUEST) << size;
  }
}

TEST_F(RpcLists, ATextThatIsNoTokenIsRefused) {
  v1::ListMotionsRequest request;
  request.set_device("devices/stage");
  request.set_page_token("2");
  grpc::ClientContext context;
  limit(context);
  v1::ListMotionsResponse response;
  EXPECT_EQ(reason(stage_->ListMotions(&context, request, &response)), v1::REASON_INVALID_REQUEST);
}

TEST_F(RpcLists, TokensAndPositionsComeInPages) {
  const auto access = v1::AccessService::NewStub(channel_);
  for (const char* name : {"b", "a", "c"}) {
    grpc::ClientContext context;
    limit(context);
    v1::CreateTokenRequest create;
    create.set_name(name);
    v1::CreateTokenResponse created;
    ASSERT_TRUE(access->CreateToken(&context, create, &created).ok());
  }
  v1::ListTokensRequest tokens;
  tokens.set_page_size(2);
  std::vector<std::string> names;
  do {
    grpc::ClientContext context;
    limit(context);
    v1::ListTokensResponse page;
    ASSERT_TRUE(access->ListTokens(&context, tokens, &page).ok());
    for (const v1::Token& token : page.tokens()) names.push_back(token.name());
    tokens.set_page_token(page.next_page_token());
  } while (!tokens.page_token().empty());
  EXPECT_THAT(names, testing::UnorderedElementsAre("a", "b", "c"));
  const auto positions = v1::PositionService::NewStub(channel_);
  for (const char* name : {"left", "right"}) {
    grpc::ClientContext context;
    limit(context);
    v1::SavePositionRequest save;
    save.set_position(std::string("devices/stage/positions/") + name);
    v1::SavePositionResponse saved;
    const grpc::Status status = positions->SavePosition(&context, save, &saved);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(saved.position().coordinates(0).position(), "0");
  }
  v1::ListPositionsRequest list;
  list.set_device("devices/stage");
  list.set_page_size(1);
  grpc::ClientContext first, second;
  limit(first);
  limit(second);
  v1::ListPositionsResponse page;
  ASSERT_TRUE(positions->ListPositions(&first, list, &page).ok());
  EXPECT_EQ(page.positions(0).name(), "devices/stage/positions/left");
  list.set_kind(v1::POSITION_KIND_COORDINATES);
  ASSERT_TRUE(positions->ListPositions(&second, list, &page).ok());
  EXPECT_THAT(page.positions(), IsEmpty());
}

TEST_F(RpcLists, ADeviceSaysWhatItCanDo) {
  grpc::ClientContext context;
  limit(context);
  v1::ListDevicesResponse response;
  ASSERT_TRUE(devices_->ListDevices(&context, v1::ListDevicesRequest(), &response).ok());
  EXPECT_THAT(
      response.devices(0).capabilities(),
      ElementsAre(v1::CAPABILITY_MOVE, v1::CAPABILITY_HOME, v1::CAPABILITY_RETURN_TO_ORIGIN, v1::CAPABILITY_JOG,
                  v1::CAPABILITY_PATH, v1::CAPABILITY_ARC, v1::CAPABILITY_SCAN, v1::CAPABILITY_SAVED_POSITIONS,
                  v1::CAPABILITY_SETTINGS, v1::CAPABILITY_PINS, v1::CAPABILITY_TRIGGER, v1::CAPABILITY_COMMANDS));
}

TEST_F(RpcLists, ATransactionThatMovesNamesItsMotion) {
  v1::ExecuteRequest request;
  request.set_device("devices/stage");
  for (const char* line : {"M:1+P100", "G:1"}) request.add_lines(line);
  grpc::ClientContext context;
  limit(context);
  const auto stream = commands_->Execute(&context, request);
  v1::ExecuteResponse response;
  ASSERT_TRUE(stream->Read(&response));
  const std::string motion = response.motion();
  EXPECT_EQ(motion, "devices/stage/motions/1");
  while (stream->Read(&response)) EXPECT_NE(response.change_case(), v1::ExecuteResponse::kMotion);
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_EQ(motion_now(motion).kind(), v1::MOTION_KIND_EXECUTE);
  grpc::ClientContext asking;
  limit(asking);
  request.clear_lines();
  request.add_lines("?:V");
  const auto question = commands_->Execute(&asking, request);
  while (question->Read(&response)) EXPECT_NE(response.change_case(), v1::ExecuteResponse::kMotion);
  EXPECT_TRUE(question->Finish().ok());
}

// A watcher that begins at next_revision misses no event between the two calls.
TEST_F(RpcLists, TheListOfDevicesHasTheRevisionAndTheClock) {
  grpc::ClientContext context;
  limit(context);
  v1::ListDevicesResponse listed;
  ASSERT_TRUE(devices_->ListDevices(&context, v1::ListDevicesRequest(), &listed).ok());
  EXPECT_EQ(listed.version(), "0.1.0");
  EXPECT_GT(listed.time().seconds(), kWritten);
  v1::Motion motion;
  ASSERT_TRUE(move(move_request(1, "0.01"), &motion).ok());
  grpc::ClientContext watching;
  limit(watching);
  v1::WatchRequest request;
  request.set_from_revision(listed.next_revision());
  request.set_run(listed.run());
  const auto events = v1::EventService::NewStub(channel_)->Watch(&watching, request);
  v1::WatchResponse first;
  ASSERT_TRUE(events->Read(&first));
  EXPECT_EQ(first.event().revision(), listed.next_revision());
  EXPECT_EQ(first.event().motion().name(), motion.name());
  watching.TryCancel();
  outcome(motion.name());
}

TEST_F(RpcLists, AMotionIsFoundByItsRequestId) {
  v1::MoveRequest asked = move_request(1, "0.01");
  asked.mutable_context()->set_request_id("scan-17");
  v1::Motion motion;
  ASSERT_TRUE(move(asked, &motion).ok());
  outcome(motion.name());
  ASSERT_TRUE(move(move_request(1, "0.02"), &motion).ok());
  outcome(motion.name());
  v1::ListMotionsRequest request;
  request.set_request_id("scan-17");
  EXPECT_THAT(ids(motions(request)), ElementsAre("1"));
}

}  // namespace
}  // namespace axisgate::rpc
