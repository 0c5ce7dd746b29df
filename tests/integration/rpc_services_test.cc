#include <gmock/gmock.h>

#include <set>
#include <thread>
#include <vector>

#include "server/connections/callers.h"
#include "server/rpc/gate/method_kinds.h"
#include "server/rpc/services.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using ::testing::ElementsAre;

const std::set<std::string> kWaiting = {"axisgate.v1.StageService/StartPath", "axisgate.v1.StageService/StartJog",
                                        "axisgate.v1.StageService/WaitMotion"};

// Each method of the services is a kind of request of its own, and is counted as what it is.
TEST(MethodKinds, EveryServedMethodHasItsOwn) {
  std::set<api::RequestKind> kinds;
  for (const ServedMethod& method : served_methods()) {
    const api::RequestKind kind = kind_of("/" + method.name);
    EXPECT_NE(kind, api::RequestKind::unlisted) << method.name;
    const api::Quota quota = api::rule_of(kind).quota;
    const bool counted = quota == api::Quota::stream || quota == api::Quota::motion_stream || quota == api::Quota::path;
    const bool waits = kWaiting.contains(method.name);  // they read a stream of the gateway for their caller
    EXPECT_EQ(counted, method.streams || waits) << method.name;
    const bool of_axisgate = method.name.starts_with("axisgate.v1.");
    EXPECT_TRUE(kinds.insert(kind).second || !of_axisgate) << method.name;
  }
  EXPECT_EQ(kinds.size() + 1, api::kRequestKinds);
}

TEST(MethodKinds, WhatIsNotServedIsUnlisted) {
  for (const char* method : {"", "/", "/axisgate.v1.StageService/Moves", "/axisgate.v2.StageService/Move",
                             "axisgate.v1.StageService/Move", "/axisgate.v1.StageService/Move/"}) {
    EXPECT_EQ(kind_of(method), api::RequestKind::unlisted) << method;
  }
}

// gRPC's own threads would sleep then, for 40 ms and more, at each try. On a busy machine one try may take long; not
// all.
TEST_F(RpcTest, ACallThatComesASecondAfterTheLastOneDoesNotWait) {
  Duration shortest = std::chrono::hours(1);
  for (int i = 0; i < 6; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1040));  // the pause that is tried
    const TimePoint begun = monotonic_now();
    grpc::ClientContext context;
    limit(context);
    v1::ListCommandsRequest request;
    request.set_device("devices/stage");
    v1::ListCommandsResponse response;
    ASSERT_TRUE(commands_->ListCommands(&context, request, &response).ok());
    shortest = std::min(shortest, Duration(monotonic_now() - begun));
  }
  EXPECT_LT(shortest, std::chrono::milliseconds(20));
}

TEST_F(RpcTest, AMoveSucceedsAndItsStateStandsInTheDevice) {
  v1::Motion motion;
  ASSERT_TRUE(move(move_request(1, "1"), &motion).ok());
  EXPECT_EQ(motion.name(), "devices/stage/motions/1");
  EXPECT_EQ(motion.caller().name(), server::caller_name(::geteuid()));
  EXPECT_GT(motion.revision(), 0u);
  const v1::Motion ended = outcome(motion.name());
  EXPECT_EQ(ended.state(), v1::MOTION_STATE_SUCCEEDED);
  EXPECT_GT(ended.revision(), motion.revision());
  ASSERT_EQ(ended.results_size(), 1);
  EXPECT_EQ(ended.results(0).target_pulses(), 100'000);  // 1 mm at 10 nm a pulse
  EXPECT_EQ(ended.results(0).command_pulses(), 100'000);

  grpc::ClientContext context;
  limit(context);
  v1::GetDeviceRequest request;
  request.set_device("devices/stage");
  request.mutable_max_age();
  v1::GetDeviceResponse response;
  ASSERT_TRUE(devices_->GetDevice(&context, request, &response).ok());
  ASSERT_EQ(response.device().axes_size(), 3);
  EXPECT_EQ(response.device().axes(0).position_pulses(), 100'000);
  EXPECT_EQ(response.device().axes(0).position(), "1000");
  EXPECT_EQ(response.device().axes(0).unit(), v1::UNIT_MICROMETERS);
  EXPECT_EQ(response.device().axes(0).travel_maximum().mm(), "5");
}

TEST_F(RpcTest, BadRequestsAreRefusedWithTheirReason) {
  v1::MoveRequest request = move_request(1, "1");
  request.set_device("devices/nowhere");
  grpc::Status status = move(request);
  EXPECT_EQ(status.error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(reason(status), v1::REASON_UNKNOWN_DEVICE);
  request.set_device("stage");
  EXPECT_EQ(reason(move(request)), v1::REASON_INVALID_REQUEST);
  EXPECT_EQ(reason(move(move_request(4, "1"))), v1::REASON_UNKNOWN_AXIS);
  EXPECT_EQ(reason(move(move_request(1, "5.1"))), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_EQ(reason(move(move_request(1, "0.0000001"))), v1::REASON_NOT_REPRESENTABLE);
  request = move_request(1, "1");
  request.mutable_targets(0)->mutable_distance()->set_degrees("1");
  EXPECT_EQ(reason(move(request)), v1::REASON_UNKNOWN_UNIT);
  request = move_request(1, "1");
  request.mutable_context()->set_request_id("a\nb");
  EXPECT_EQ(reason(move(request)), v1::REASON_INVALID_REQUEST);
  request = move_request(1, "1");
  request.mutable_context()->mutable_not_after()->set_seconds(1);
  EXPECT_EQ(reason(move(request)), v1::REASON_DEADLINE_PASSED);
}

TEST_F(RpcTest, ValidateOnlyChecksAndMovesNothing) {
  v1::MoveRequest request = move_request(1, "1");
  request.set_validate_only(true);
  EXPECT_TRUE(move(request).ok());
  request = move_request(1, "6");
  request.set_validate_only(true);
  EXPECT_EQ(reason(move(request)), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_EQ(motion_count(), 0);
}

// The revisions that a watcher sees, until the first motion's outcome.
std::vector<std::uint64_t> watch(v1::EventService::Stub& stub, std::uint64_t from) {
  grpc::ClientContext context;
  context.set_deadline(server::to_wall(monotonic_now() + std::chrono::seconds(30)));
  v1::WatchRequest request;
  request.set_from_revision(from);
  const auto stream = stub.Watch(&context, request);
  std::vector<std::uint64_t> revisions;
  v1::WatchResponse response;
  while (stream->Read(&response)) {
    revisions.push_back(response.event().revision());
    if (response.event().motion().state() >= v1::MOTION_STATE_SUCCEEDED) break;
  }
  context.TryCancel();
  return revisions;
}

TEST_F(RpcTest, ThreeWatchersSeeTheSameRevisionsAndOneThatComesBackMissesNone) {
  std::vector<std::vector<std::uint64_t>> seen(3);
  std::vector<std::thread> watchers;
  for (auto& revisions : seen) watchers.emplace_back([&] { revisions = watch(*events_, 1); });
  ASSERT_TRUE(move(move_request(1, "1")).ok());
  for (std::thread& watcher : watchers) watcher.join();
  ASSERT_FALSE(seen[0].empty());
  for (std::size_t i = 0; i < seen[0].size(); ++i) EXPECT_EQ(seen[0][i], i + 1);
  EXPECT_EQ(seen[1], seen[0]);
  EXPECT_EQ(seen[2], seen[0]);
  const std::vector<std::uint64_t> rest(seen[0].begin() + 2, seen[0].end());
  EXPECT_EQ(watch(*events_, 3), rest);
}

TEST_F(RpcTest, TheTimesOfAMotionAreTheSameInEachAnswer) {
  v1::Motion moved;
  ASSERT_TRUE(move(move_request(1, "1"), &moved).ok());
  const v1::Motion over = outcome(moved.name());
  ASSERT_TRUE(moved.has_start_time() && over.has_end_time());
  for (int reading = 0; reading < 10; ++reading) {
    const v1::Motion now = motion_now(moved.name());
    EXPECT_EQ(now.create_time().SerializeAsString(), moved.create_time().SerializeAsString());
    EXPECT_EQ(now.start_time().SerializeAsString(), moved.start_time().SerializeAsString());
    EXPECT_EQ(now.end_time().SerializeAsString(), over.end_time().SerializeAsString());
  }
}

TEST_F(RpcTest, ARevisionOfAnotherRunIsCompacted) {
  grpc::ClientContext context;
  limit(context);
  v1::WatchRequest request;
  request.set_from_revision(1);
  request.set_run("another");
  const auto stream = events_->Watch(&context, request);
  v1::WatchResponse response;
  EXPECT_FALSE(stream->Read(&response));
  const grpc::Status status = stream->Finish();
  EXPECT_EQ(reason(status), v1::REASON_COMPACTED);
  EXPECT_EQ(context.GetServerTrailingMetadata().count("grpc-status-details-bin"), 1u);
}

v1::RunPathRequest header() {
  v1::RunPathRequest part;
  part.mutable_header()->set_device("devices/stage");
  return part;
}

v1::RunPathRequest segment_request(const std::string& um) {
  v1::RunPathRequest part;
  part.mutable_segment()->set_relative(true);
  part.mutable_segment()->mutable_single()->set_axis("1");
  part.mutable_segment()->mutable_single()->mutable_distance()->set_um(um);
  return part;
}

TEST_F(RpcTest, APathTellsEveryStepAndItsOutcome) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = stage_->RunPath(&context);
  stream->Write(header());
  for (const char* um : {"50", "-20", "30"}) stream->Write(segment_request(um));
  stream->WritesDone();
  std::vector<int> sent;
  std::vector<int> done;
  std::vector<v1::MotionState> states;
  v1::RunPathResponse response;
  while (stream->Read(&response)) {
    if (response.has_motion()) states.push_back(response.motion().state());
    const v1::PathProgress& progress = response.progress();
    if (progress.step() == v1::PathProgress::STEP_SENT) sent.push_back(progress.segment());
    if (progress.step() == v1::PathProgress::STEP_DONE) done.push_back(progress.segment());
  }
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_THAT(sent, ElementsAre(1, 2, 3));
  EXPECT_THAT(done, ElementsAre(1, 2, 3));
  EXPECT_THAT(states, ElementsAre(v1::MOTION_STATE_RUNNING, v1::MOTION_STATE_SUCCEEDED));
}

TEST_F(RpcTest, ABadSegmentIsNamed) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = stage_->RunPath(&context);
  stream->Write(header());
  stream->Write(segment_request("50"));
  stream->Write(segment_request("fast"));
  stream->WritesDone();
  v1::RunPathResponse response;
  EXPECT_FALSE(stream->Read(&response));
  const grpc::Status status = stream->Finish();
  EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), ::testing::StartsWith("segment 2: "));
  EXPECT_EQ(motion_count(), 0);
}

TEST_F(RpcTest, InputsStartNothing) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = stage_->RunPath(&context);
  stream->Write(header());
  v1::RunPathRequest waits = segment_request("50");
  waits.mutable_segment()->mutable_inputs();  // none is on
  stream->Write(waits);
  stream->WritesDone();
  v1::RunPathResponse response;
  EXPECT_FALSE(stream->Read(&response));
  const grpc::Status status = stream->Finish();
  EXPECT_EQ(status.error_code(), grpc::PERMISSION_DENIED);
  EXPECT_EQ(reason(status), v1::REASON_NOT_ALLOWED);
  EXPECT_EQ(motion_count(), 0);
}

TEST_F(RpcTest, AClientThatBreaksOffAPathStartsNothing) {
  for (int i = 0; i < 20; ++i) {
    grpc::ClientContext context;
    const auto stream = stage_->RunPath(&context);
    stream->Write(header());
    stream->Write(segment_request("50"));
    context.TryCancel();
    EXPECT_EQ(stream->Finish().error_code(), grpc::CANCELLED);
  }
  // A move started afterwards is the first motion: it waits longer than a path would to start.
  v1::Motion motion;
  ASSERT_TRUE(move(move_request(2, "1"), &motion).ok());
  outcome(motion.name());
  EXPECT_EQ(motion_count(), 1);
}

TEST_F(RpcTest, ExecuteStreamsRepliesThenCompletions) {
  grpc::ClientContext context;
  limit(context);
  v1::ExecuteRequest request;
  request.set_device("devices/stage");
  request.add_lines("?:P1");
  const auto stream = commands_->Execute(&context, request);
  v1::ExecuteResponse response;
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.reply().answer(), "10");
  EXPECT_EQ(response.reply().sent(), "?:P");
  EXPECT_EQ(response.reply().wire_reply(), "10,10,10");
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_TRUE(stream->Finish().ok());
}

TEST_F(RpcTest, ExecuteRefusesWhatIsNoLine) {
  for (const char* line : {"G:1", "BOGUS", "Q:\r\nG:", "Q:\x7f", ""}) {
    grpc::ClientContext context;
    limit(context);
    v1::ExecuteRequest request;
    request.set_device("devices/stage");
    request.add_lines(line);
    const auto stream = commands_->Execute(&context, request);
    v1::ExecuteResponse response;
    EXPECT_FALSE(stream->Read(&response)) << line;
    EXPECT_EQ(stream->Finish().error_code(), grpc::INVALID_ARGUMENT) << line;
  }
}

TEST_F(RpcTest, StopAnswersPerAxisAndTheMotionIsStopped) {
  v1::Motion motion;
  ASSERT_TRUE(move(move_request(1, "5"), &motion).ok());
  grpc::ClientContext context;
  limit(context);
  v1::StopRequest request;
  request.set_device("devices/stage");
  v1::StopResponse response;
  ASSERT_TRUE(stage_->Stop(&context, request, &response).ok());
  ASSERT_EQ(response.devices_size(), 1);
  const v1::DeviceStop& stopped = response.devices(0);
  EXPECT_EQ(stopped.device(), "devices/stage");
  ASSERT_EQ(stopped.axes_size(), 3);
  EXPECT_EQ(stopped.axes(0).wire_reply(), "OK");
  EXPECT_TRUE(stopped.axes(0).ready());
  EXPECT_EQ(stopped.axes(1).position(), "0");
  EXPECT_EQ(outcome(motion.name()).state(), v1::MOTION_STATE_STOPPED);
}

TEST_F(RpcTest, TheDaemonEndsWithStreamsOpen) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = events_->Watch(&context, v1::WatchRequest());
  stream->WaitForInitialMetadata();
  doors_.reset();
  gateway_.reset();
  v1::WatchResponse response;
  while (stream->Read(&response)) {
  }
  EXPECT_FALSE(stream->Finish().ok());
}

TEST_F(RpcTest, ASecondServerIsRefused) {
  server::Config same_address = gateway_->config();
  same_address.listen = doors_->listen();
  same_address.socket += "2";
  server::Gateway second(same_address, 2);
  const auto tcp = server::Doors::open(second, *access_, *positions_, limits_);
  ASSERT_FALSE(tcp);
  EXPECT_THAT(tcp.error().message, ::testing::HasSubstr("Address already in use"));
  const auto socket = server::Doors::open(*gateway_, *access_, *positions_, limits_);
  ASSERT_FALSE(socket);
  EXPECT_THAT(socket.error().message, ::testing::HasSubstr("is served by another process already"));
}

}  // namespace
}  // namespace axisgate::rpc
