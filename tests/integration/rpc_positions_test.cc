// PositionService: what is checked before anything is sent, and what the gateway knows of a position without asking.
#include <gmock/gmock.h>

#include <set>
#include <thread>

#include "axisgate/v1/position.grpc.pb.h"
#include "axisgate/v1/settings.grpc.pb.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

class RpcPositions : public RpcTest {
 protected:
  void SetUp() override {
    RpcTest::SetUp();
    stub_ = v1::PositionService::NewStub(channel_);
  }

  static std::string called(const std::string& name) { return "devices/stage/positions/" + name; }

  static v1::SavePositionRequest saving(const std::string& name,
                                        v1::PositionKind kind = v1::POSITION_KIND_UNSPECIFIED) {
    v1::SavePositionRequest request;
    request.set_position(called(name));
    request.set_kind(kind);
    return request;
  }
  grpc::Status save(const v1::SavePositionRequest& request, v1::Position* position = nullptr) {
    grpc::ClientContext context;
    limit(context);
    v1::SavePositionResponse response;
    const grpc::Status status = stub_->SavePosition(&context, request, &response);
    if (position != nullptr) *position = response.position();
    return status;
  }
  v1::Position saved(const std::string& name, v1::PositionKind kind = v1::POSITION_KIND_UNSPECIFIED) {
    v1::Position position;
    const grpc::Status status = save(saving(name, kind), &position);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return position;
  }
  std::vector<v1::Position> list() {
    grpc::ClientContext context;
    limit(context);
    v1::ListPositionsRequest request;
    request.set_device("devices/stage");
    v1::ListPositionsResponse response;
    EXPECT_TRUE(stub_->ListPositions(&context, request, &response).ok());
    return {response.positions().begin(), response.positions().end()};
  }
  grpc::Status forget(const std::string& name, bool validate_only = false) {
    grpc::ClientContext context;
    limit(context);
    v1::DeletePositionRequest request;
    request.set_position(called(name));
    request.set_validate_only(validate_only);
    v1::DeletePositionResponse response;
    return stub_->DeletePosition(&context, request, &response);
  }
  grpc::Status go(const std::string& name, v1::Motion* motion = nullptr, bool validate_only = false) {
    grpc::ClientContext context;
    limit(context);
    v1::MoveToPositionRequest request;
    request.set_position(called(name));
    request.set_validate_only(validate_only);
    v1::MoveToPositionResponse response;
    const grpc::Status status = stub_->MoveToPosition(&context, request, &response);
    if (motion != nullptr) *motion = response.motion();
    return status;
  }
  void expect_reached(const std::string& name, int axis, std::int64_t pulses) {
    v1::Motion motion;
    const grpc::Status status = go(name, &motion);
    ASSERT_TRUE(status.ok()) << status.error_message();
    const v1::Motion ended = outcome(motion.name());
    EXPECT_EQ(ended.state(), v1::MOTION_STATE_SUCCEEDED);
    EXPECT_EQ(ended.kind(), v1::MOTION_KIND_MOVE);
    EXPECT_EQ(ended.results(axis - 1).command_pulses(), pulses);
  }
  void moved(int axis, const std::string& mm) {
    v1::Motion motion;
    ASSERT_TRUE(move(move_request(axis, mm), &motion).ok());
    ASSERT_EQ(outcome(motion.name()).state(), v1::MOTION_STATE_SUCCEEDED);
  }
  // One line of the controller's own, and its answer.
  std::string controller(const std::string& line) {
    grpc::ClientContext context;
    limit(context);
    v1::ExecuteRequest request;
    request.set_device("devices/stage");
    request.add_lines(line);
    const auto stream = commands_->Execute(&context, request);
    v1::ExecuteResponse response;
    std::string answer;
    while (stream->Read(&response)) answer += response.reply().answer();
    (void)stream->Finish();
    return answer;
  }
  void reset() {
    const std::uint64_t epoch = device().device_epoch();
    controller("RESET:");
    for (int look = 0; look < 600 && device().device_epoch() == epoch; ++look) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // between two looks; their number decides
    }
    wait_until_up();
    ASSERT_GT(device().device_epoch(), epoch);
  }
  v1::Device device() {
    grpc::ClientContext context;
    limit(context);
    v1::GetDeviceRequest request;
    request.set_device("devices/stage");
    v1::GetDeviceResponse response;
    EXPECT_TRUE(devices_->GetDevice(&context, request, &response).ok());
    return response.device();
  }

  std::unique_ptr<v1::PositionService::Stub> stub_;
};

TEST_F(RpcPositions, SavedListedGoneToAndForgotten) {
  moved(1, "1");
  const v1::Position sample = saved("sample");
  EXPECT_EQ(sample.name(), called("sample"));
  EXPECT_EQ(sample.kind(), v1::POSITION_KIND_PLACE);
  EXPECT_EQ(sample.number(), 1);
  ASSERT_EQ(sample.coordinates_size(), 3);
  EXPECT_EQ(sample.coordinates(0).axis(), 1);
  EXPECT_EQ(sample.coordinates(0).pulses(), 100'000);  // 1 mm at 10 nm a pulse
  EXPECT_EQ(sample.caller().name(), server::caller_name(::geteuid()));
  EXPECT_GT(sample.save_time().seconds(), 1'700'000'000);
  EXPECT_FALSE(sample.emptied());
  EXPECT_EQ(controller("PIT:GET,1"), "100000,0,0");
  moved(1, "2");
  EXPECT_EQ(saved("park", v1::POSITION_KIND_COORDINATES).number(), 1);
  EXPECT_EQ(saved("other").number(), 2);
  EXPECT_EQ(list().size(), 3u);
  expect_reached("sample", 1, 100'000);
  expect_reached("park", 1, 200'000);
  ASSERT_TRUE(forget("sample").ok());
  EXPECT_EQ(controller("PIT:GET,1"), "NG");
  EXPECT_EQ(reason(go("sample")), v1::REASON_NOT_FOUND);
  EXPECT_EQ(go("sample").error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(reason(forget("sample")), v1::REASON_NOT_FOUND);
  EXPECT_EQ(list().size(), 2u);
}

TEST_F(RpcPositions, ANameMeansTheNewPlaceUnlessTheOldIsKept) {
  saved("sample");
  moved(1, "1");
  v1::SavePositionRequest request = saving("sample");
  request.set_keep_existing(true);
  EXPECT_EQ(reason(save(request)), v1::REASON_INVALID_REQUEST);
  EXPECT_EQ(controller("PIT:GET,1"), "0,0,0");
  EXPECT_EQ(saved("sample").number(), 1);
  moved(1, "0");
  expect_reached("sample", 1, 100'000);
  // A position of the other kind has another number, and the old number is free again.
  EXPECT_EQ(saved("sample", v1::POSITION_KIND_COORDINATES).kind(), v1::POSITION_KIND_COORDINATES);
  EXPECT_EQ(list().size(), 1u);
  EXPECT_EQ(saved("next").number(), 1);
}

TEST_F(RpcPositions, SavedAtOnceEachHasANumber) {
  std::vector<std::thread> callers;
  std::vector<int> numbers(6);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    callers.emplace_back([this, &numbers, i] { numbers[i] = saved("p" + std::to_string(i)).number(); });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(std::set<int>(numbers.begin(), numbers.end()), (std::set<int>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(list().size(), 6u);
}

TEST_F(RpcPositions, BadNamesAreRefused) {
  for (const char* name : {"", "a b", "a/b", "a.b", "aaaaaaaaaabbbbbbbbbbccccccccccdddddddddde"}) {
    EXPECT_EQ(reason(save(saving(name))), v1::REASON_INVALID_REQUEST) << name;
    EXPECT_EQ(reason(go(name)), v1::REASON_INVALID_REQUEST) << name;
    EXPECT_EQ(reason(forget(name)), v1::REASON_INVALID_REQUEST) << name;
  }
  v1::SavePositionRequest request;
  request.set_position("devices/nowhere/positions/a");
  EXPECT_EQ(reason(save(request)), v1::REASON_UNKNOWN_DEVICE);
  request = saving("a");
  request.set_kind(static_cast<v1::PositionKind>(7));
  EXPECT_EQ(reason(save(request)), v1::REASON_INVALID_REQUEST);
  EXPECT_TRUE(list().empty());
}

TEST_F(RpcPositions, ValidateOnlySendsNothing) {
  v1::SavePositionRequest request = saving("sample");
  request.set_validate_only(true);
  EXPECT_TRUE(save(request).ok());
  EXPECT_EQ(controller("PIT:GET,1"), "NG");
  EXPECT_TRUE(list().empty());
  saved("sample");
  moved(1, "1");
  const int motions = motion_count();
  EXPECT_TRUE(go("sample", nullptr, true).ok());
  EXPECT_EQ(reason(go("none", nullptr, true)), v1::REASON_NOT_FOUND);
  EXPECT_TRUE(forget("sample", true).ok());
  EXPECT_EQ(motion_count(), motions);
  EXPECT_EQ(controller("PIT:GET,1"), "0,0,0");
  EXPECT_EQ(list().size(), 1u);
}

TEST_F(RpcPositions, OutsideTheTravelLimits) {
  controller("PSET:1+P600000");
  saved("far", v1::POSITION_KIND_COORDINATES);
  controller("PSET:1+P0");
  EXPECT_EQ(reason(go("far", nullptr, true)), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_EQ(reason(go("far")), v1::REASON_OUTSIDE_TRAVEL);
}

// Wherever 0 is counted from by then (manual 129)): by R:, or since the axes have found their origins.
TEST_F(RpcPositions, APlaceStaysWhereItIs) {
  moved(1, "1");
  saved("sample");
  saved("park", v1::POSITION_KIND_COORDINATES);
  moved(1, "1.5");
  EXPECT_EQ(controller("R:1"), "OK");
  expect_reached("sample", 1, -50'000);
  expect_reached("park", 1, 100'000);
  v1::HomeRequest request;
  request.set_device("devices/stage");
  grpc::ClientContext context;
  limit(context);
  v1::HomeResponse response;
  saved("before");
  ASSERT_TRUE(stage_->Home(&context, request, &response).ok());
  ASSERT_EQ(outcome(response.motion().name()).state(), v1::MOTION_STATE_SUCCEEDED);
  EXPECT_TRUE(go("before").ok());
}

TEST_F(RpcPositions, AResetEmptiesPlacesAndSaysSo) {
  moved(1, "1");
  saved("sample");
  saved("park", v1::POSITION_KIND_COORDINATES);
  reset();
  for (const v1::Position& position : list()) {
    EXPECT_EQ(position.emptied(), position.kind() == v1::POSITION_KIND_PLACE) << position.name();
  }
  const int motions = motion_count();
  const grpc::Status gone = go("sample");
  EXPECT_EQ(reason(gone), v1::REASON_EPOCH_PASSED);
  EXPECT_EQ(gone.error_code(), grpc::FAILED_PRECONDITION);
  EXPECT_THAT(gone.error_message(),
              testing::MatchesRegex("\"sample\" is no longer there: the controller holds nothing under number 1 "
                                    "of its positions \\(PIT:\\); the controller came back [0-9]+ s ago, and may have "
                                    "restarted, which deletes its saved positions.*"));
  EXPECT_EQ(motion_count(), motions + 1);  // the motion that failed
  expect_reached("park", 1, 100'000);
  EXPECT_FALSE(saved("sample").emptied());
  expect_reached("sample", 1, 100'000);
}

// After a restart nothing of it is left to be deleted, and the name goes all the same.
TEST_F(RpcPositions, WhatTheControllerHasForgottenIsForgotten) {
  saved("sample");
  reset();
  EXPECT_TRUE(forget("sample").ok());
  EXPECT_TRUE(list().empty());
}

// In another run of the daemon nobody knows whether the controller was restarted, so it is asked.
TEST_F(RpcPositions, OfAnEarlierRunOfTheDaemon) {
  moved(1, "1");
  saved("sample");
  auto position = *positions_->find("stage", "sample");
  positions_->held_in(position, {});  // as it is read from the file
  EXPECT_TRUE(list().front().emptied());
  moved(1, "0");
  expect_reached("sample", 1, 100'000);
  EXPECT_FALSE(list().front().emptied());
  // Its coordinates were set again, or its number was used for another place: nobody knows.
  positions_->held_in(position, {});
  EXPECT_EQ(controller("PSET:1+P5"), "OK");
  EXPECT_EQ(reason(go("sample")), v1::REASON_EPOCH_PASSED);
  position.serial_number = "1111111111";
  ASSERT_TRUE(positions_->keep(position));
  EXPECT_TRUE(list().front().emptied());
  EXPECT_EQ(reason(go("sample")), v1::REASON_EPOCH_PASSED);
  // The position that the present controller has under that number is not deleted.
  EXPECT_TRUE(forget("sample").ok());
  EXPECT_EQ(controller("PIT:GET,1"), "5,0,0");
}

TEST_F(RpcPositions, ACallersOwnEpochIsRefusedInItsOwnWords) {
  saved("sample");
  grpc::ClientContext context;
  limit(context);
  v1::MoveToPositionRequest request;
  request.set_position(called("sample"));
  request.mutable_context()->set_device_epoch(99);
  v1::MoveToPositionResponse response;
  const grpc::Status status = stub_->MoveToPosition(&context, request, &response);
  EXPECT_EQ(reason(status), v1::REASON_EPOCH_PASSED);
  EXPECT_THAT(status.error_message(), testing::HasSubstr("device epoch 99"));
  EXPECT_THAT(status.error_message(), testing::Not(testing::HasSubstr("sample")));
}

TEST_F(RpcPositions, AnotherHoldsTheAxes) {
  saved("sample");
  grpc::ClientContext context;
  limit(context);
  v1::AcquireLeaseRequest request;
  request.set_device("devices/stage");
  request.mutable_terms()->add_axes("2");
  v1::AcquireLeaseResponse lease;
  ASSERT_TRUE(control_->AcquireLease(&context, request, &lease).ok());
  EXPECT_EQ(reason(save(saving("sample"))), v1::REASON_LEASE_HELD);
  EXPECT_EQ(reason(go("sample")), v1::REASON_LEASE_HELD);
  EXPECT_EQ(reason(forget("sample")), v1::REASON_LEASE_HELD);
  ASSERT_EQ(list().size(), 1u);
  EXPECT_FALSE(list().front().emptied());
}

}  // namespace
}  // namespace axisgate::rpc
