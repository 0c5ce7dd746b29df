// A stage of another pulse than its profile's, over gRPC: what is refused before anything is done, and what is shown.
#include <gmock/gmock.h>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using ::testing::HasSubstr;

// 10 nm a pulse: axis 1 has another stage, axis 2 turns, axis 3 has no profile.
class RpcStage : public RpcTest {
 protected:
  void configure(server::Config& config) override {
    auto& axes = std::get<server::StageConfig>(config.devices[0].family).profile.axes;
    axes[0].stage = stage::StageProfile{"Other", {{20, 0}, false}, {}};
    axes[1].unit = Unit::degrees;
    axes[1].stage = stage::StageProfile{"Turner", {{10, 0}, true}, Decimal{5, 0}};
  }

  v1::Device device() {
    grpc::ClientContext context;
    limit(context);
    v1::GetDeviceRequest request;
    request.set_device("devices/stage");
    request.mutable_max_age();
    v1::GetDeviceResponse response;
    EXPECT_TRUE(devices_->GetDevice(&context, request, &response).ok());
    return response.device();
  }

  grpc::Status would_home(int axis) {
    grpc::ClientContext context;
    limit(context);
    v1::HomeRequest request;
    request.set_device("devices/stage");
    request.add_axes(std::to_string(axis));
    request.set_validate_only(true);
    v1::HomeResponse response;
    return stage_->Home(&context, request, &response);
  }
};

TEST_F(RpcStage, IsToldWithEveryAxis) {
  const v1::Device shown = device();
  ASSERT_EQ(shown.axes_size(), 3);
  EXPECT_EQ(shown.axes(0).stage(), "Other");
  EXPECT_THAT(shown.axes(0).stage_problem(), HasSubstr("10 nm by the controller and 20 nm by the profile"));
  EXPECT_EQ(shown.axes(0).position_in_turn(), "");
  EXPECT_EQ(shown.axes(1).stage(), "Turner");
  EXPECT_EQ(shown.axes(1).stage_problem(), "");
  EXPECT_EQ(shown.axes(1).position_in_turn(), "0");
  EXPECT_EQ(shown.axes(2).stage() + shown.axes(2).stage_problem() + shown.axes(2).position_in_turn(), "");
}

TEST_F(RpcStage, WhatIsOnlyCheckedIsRefusedAlike) {
  v1::MoveRequest request = move_request(1, "1");
  request.set_validate_only(true);
  EXPECT_EQ(reason(move(request)), v1::REASON_IDENTITY_MISMATCH);
  EXPECT_EQ(reason(would_home(1)), v1::REASON_IDENTITY_MISMATCH);
  EXPECT_TRUE(would_home(2).ok());
  EXPECT_EQ(motion_count(), 0);
}

}  // namespace
}  // namespace axisgate::rpc
