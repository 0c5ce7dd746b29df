// StageService.Scan of a whole gateway.
#include <gmock/gmock.h>

#include <string>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using ::testing::HasSubstr;

class RpcScan : public RpcTest {
 protected:
  // Axis 1, which ends at 5 mm, at the simulator's F of 50,000 pulses/s; 10 nm a pulse.
  static v1::ScanRequest scan_request(std::int64_t from, std::int64_t to) {
    v1::ScanRequest request;
    request.set_device("devices/stage");
    request.set_axis("1");
    request.mutable_start()->set_pulses(from);
    request.mutable_end()->set_pulses(to);
    request.mutable_distance()->set_pulses(1000);
    return request;
  }

  grpc::Status scan(const v1::ScanRequest& request, v1::Motion* motion = nullptr) {
    grpc::ClientContext context;
    limit(context);
    v1::ScanResponse response;
    const grpc::Status status = stage_->Scan(&context, request, &response);
    if (motion != nullptr) *motion = response.motion();
    return status;
  }
};

TEST_F(RpcScan, IsToldWithWhatItCameTo) {
  v1::Motion motion;
  const grpc::Status status = scan(scan_request(0, 10'050), &motion);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(motion.kind(), v1::MOTION_KIND_SCAN);
  const v1::Motion ended = outcome(motion.name());
  EXPECT_EQ(ended.state(), v1::MOTION_STATE_SUCCEEDED) << ended.problem().message();
  // At 0, 1000, ... 10,000; the way before is a whole number of intervals.
  EXPECT_EQ(ended.scan().expected_triggers_in_range(), 11);
  EXPECT_LT(ended.scan().run_from_pulses(), 0);
  EXPECT_EQ(ended.scan().run_from_pulses() % 1000, 0);
  EXPECT_GE(ended.scan().run_to_pulses(), 10'050);
  EXPECT_EQ(ended.scan().expected_triggers(), (ended.scan().run_to_pulses() - ended.scan().run_from_pulses()) / 1000);
  EXPECT_EQ(ended.scan().observed_triggers(), ended.scan().expected_triggers());
}

TEST_F(RpcScan, WhatCannotBeIsRefused) {
  v1::ScanRequest request = scan_request(0, 10'000);
  request.set_device("devices/nowhere");
  EXPECT_EQ(reason(scan(request)), v1::REASON_UNKNOWN_DEVICE);
  request = scan_request(0, 10'000);
  request.mutable_context()->set_request_id("a\nb");
  EXPECT_EQ(reason(scan(request)), v1::REASON_INVALID_REQUEST);
  request = scan_request(0, 10'000);
  request.clear_interval();
  EXPECT_EQ(reason(scan(request)), v1::REASON_INVALID_REQUEST);
  EXPECT_EQ(motion_count(), 0);
}

TEST_F(RpcScan, ValidateOnlyChecksAndMovesNothing) {
  v1::ScanRequest request = scan_request(0, 10'000);
  request.set_validate_only(true);
  EXPECT_TRUE(scan(request).ok());
  EXPECT_EQ(motion_count(), 0);
}

TEST_F(RpcScan, ItsCheckIsTheControllers) {
  for (const bool validate_only : {true, false}) {
    v1::ScanRequest beyond = scan_request(0, 500'001);
    beyond.set_validate_only(validate_only);
    EXPECT_EQ(reason(scan(beyond)), v1::REASON_OUTSIDE_TRAVEL);
    v1::ScanRequest fast = scan_request(0, 10'000);
    fast.set_validate_only(validate_only);
    fast.mutable_speed()->set_pulses_per_s(56'001);  // manual 98) T:P
    const grpc::Status status = scan(fast);
    EXPECT_EQ(reason(status), v1::REASON_TOO_FAST);
    EXPECT_THAT(status.error_message(), HasSubstr("56"));
  }
  EXPECT_EQ(motion_count(), 0);
}

}  // namespace
}  // namespace axisgate::rpc
