// Axes by name, amounts as floating-point numbers, and results in the unit of the axis, over gRPC.
#include <google/protobuf/util/time_util.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "axisgate/v1/settings.grpc.pb.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

class RpcAmounts : public RpcTest {
 protected:
  void configure(server::Config& config) override {
    stage::Profile& profile = std::get<server::StageConfig>(config.devices[0].family).profile;
    profile.axes[0].name = "x";
    profile.axes[1].name = "y";
    profile.axes[0].unit = Unit::micrometers;
  }

  static v1::MoveRequest floating(double value, v1::Rounding rounding, v1::Unit unit = v1::UNIT_MILLIMETERS) {
    v1::MoveRequest request;
    request.set_device("devices/stage");
    v1::AxisTarget& target = *request.add_targets();
    target.set_axis("x");
    v1::FloatingAmount& amount = *target.mutable_distance()->mutable_floating();
    amount.set_value(value);
    amount.set_unit(unit);
    amount.set_rounding(rounding);
    return request;
  }
};

// The simulated stage has pulses of 10 nm: 0.30000000000000004 mm is not a whole number of them.
TEST_F(RpcAmounts, AFloatIsRoundedIfTheRequestSaysSo) {
  EXPECT_EQ(reason(move(floating(0.1 + 0.2, v1::ROUNDING_REFUSE))), v1::REASON_NOT_REPRESENTABLE);
  EXPECT_EQ(reason(move(floating(0.1 + 0.2, v1::ROUNDING_UNSPECIFIED))), v1::REASON_NOT_REPRESENTABLE);
  v1::Motion motion;
  ASSERT_TRUE(move(floating(0.1 + 0.2, v1::ROUNDING_NEAREST), &motion).ok());
  const v1::Motion ended = outcome(motion.name());
  ASSERT_EQ(ended.results_size(), 1);
  const v1::AxisResult& result = ended.results(0);
  EXPECT_EQ(result.target_pulses(), 30'000);
  EXPECT_EQ(result.command_pulses(), 30'000);
  EXPECT_EQ(result.name() + " " + result.target() + " " + result.position(), "x 300 300");
  EXPECT_EQ(result.unit(), v1::UNIT_MICROMETERS);
}

TEST_F(RpcAmounts, AFloatThatIsNoAmountIsRefused) {
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_EQ(reason(move(floating(value, v1::ROUNDING_NEAREST))), v1::REASON_INVALID_REQUEST) << value;
  }
  EXPECT_EQ(reason(move(floating(1, v1::ROUNDING_NEAREST, v1::UNIT_UNSPECIFIED))), v1::REASON_INVALID_REQUEST);
  EXPECT_EQ(reason(move(floating(1, v1::ROUNDING_NEAREST, v1::UNIT_DEGREES))), v1::REASON_UNKNOWN_UNIT);
  EXPECT_EQ(reason(move(floating(1e300, v1::ROUNDING_NEAREST))), v1::REASON_OUT_OF_RANGE);
  EXPECT_EQ(motion_count(), 0);
}

TEST_F(RpcAmounts, AnAxisHasItsNameAndItsNumber) {
  v1::MoveRequest both = floating(0.01, v1::ROUNDING_REFUSE);
  *both.add_targets() = both.targets(0);
  both.mutable_targets(1)->set_axis("y");
  v1::Motion motion;
  ASSERT_TRUE(move(both, &motion).ok());
  EXPECT_EQ(outcome(motion.name()).axes_size(), 2);
  both.mutable_targets(1)->set_axis("1");
  EXPECT_EQ(reason(move(both)), v1::REASON_INVALID_REQUEST);
  both.mutable_targets(1)->set_axis("z");
  const grpc::Status unknown = move(both);
  EXPECT_EQ(reason(unknown), v1::REASON_UNKNOWN_AXIS);
  EXPECT_EQ(problem(unknown).hint(), "x is axis 1, y is axis 2");
}

// A stop is not refused for its axes before its device is known.
TEST_F(RpcAmounts, AStopNamesItsDeviceFirst) {
  const auto stop = [this](const std::string& device, const std::string& axis) {
    grpc::ClientContext context;
    limit(context);
    v1::StopRequest request;
    request.set_device(device);
    request.add_axes(axis);
    v1::StopResponse response;
    return reason(stage_->Stop(&context, request, &response));
  };
  EXPECT_EQ(stop("devices/typo", "z"), v1::REASON_UNKNOWN_DEVICE);
  EXPECT_EQ(stop("devices/stage", "z"), v1::REASON_UNKNOWN_AXIS);
  EXPECT_EQ(stop("", "y"), v1::REASON_UNSPECIFIED);
}

TEST_F(RpcAmounts, TheTriggerTakesADistanceOrATime) {
  const auto settings = v1::SettingService::NewStub(channel_);
  v1::ChangeSettingsRequest request;
  request.set_device("devices/stage");
  v1::Trigger& trigger = *request.mutable_settings()->mutable_trigger();
  const auto change = [&] {
    grpc::ClientContext context;
    limit(context);
    v1::ChangeSettingsResponse response;
    return reason(settings->ChangeSettings(&context, request, &response));
  };
  const auto trigger_now = [&] {
    grpc::ClientContext context;
    limit(context);
    v1::GetDeviceRequest ask;
    ask.set_device("devices/stage");
    v1::GetDeviceResponse response;
    EXPECT_TRUE(devices_->GetDevice(&context, ask, &response).ok());
    return response.device().trigger();
  };
  trigger.set_target(v1::Trigger::TARGET_DRIVE_PULSES);
  trigger.mutable_distance()->set_um("10");
  EXPECT_EQ(change(), v1::REASON_INVALID_REQUEST);  // no axis
  trigger.set_axis("y");
  EXPECT_EQ(change(), v1::REASON_UNSPECIFIED);
  EXPECT_EQ(trigger_now().axis(), "2");
  EXPECT_EQ(trigger_now().distance().pulses(), 1000);
  trigger.set_target(v1::Trigger::TARGET_TIMER);
  EXPECT_EQ(change(), v1::REASON_INVALID_REQUEST);  // a distance
  trigger.clear_axis();
  *trigger.mutable_period() = google::protobuf::util::TimeUtil::MillisecondsToDuration(200);
  EXPECT_EQ(change(), v1::REASON_UNSPECIFIED);
  EXPECT_EQ(google::protobuf::util::TimeUtil::DurationToMilliseconds(trigger_now().period()), 200);
  *trigger.mutable_period() = google::protobuf::util::TimeUtil::MillisecondsToDuration(205);
  EXPECT_EQ(change(), v1::REASON_NOT_REPRESENTABLE);
  *trigger.mutable_period() = google::protobuf::util::TimeUtil::MillisecondsToDuration(0);
  EXPECT_EQ(change(), v1::REASON_OUT_OF_RANGE);
}

}  // namespace
}  // namespace axisgate::rpc
