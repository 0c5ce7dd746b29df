// The travel envelope of a whole gateway: who is who, and what a caller's own lines may do.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using Lines = std::vector<std::string>;
using ::testing::HasSubstr;

Quantity millimeters(std::int64_t digits, int decimals = 0) { return {{digits, decimals}, Unit::millimeters}; }

// 10 nm a pulse. Axis 1 from -5 mm to 5 mm at 0.6 mm/s at most: operators to 3 mm, this test's own user to 2 mm. Axis 2
// without the coordinate 0, axis 3 only once it was homed.
class RpcEnvelope : public RpcTest {
 protected:
  void configure(server::Config& config) override {
    auto& axes = std::get<server::StageConfig>(config.devices[0].family).profile.axes;
    axes[0].travel_minimum = millimeters(-5);
    axes[0].travel_maximum = millimeters(5);
    axes[0].maximum_speed = millimeters(6, 1);
    for (const auto& [whose, maximum] : {std::pair(std::string("operator"), 3), std::pair(own_name(), 2)}) {
      auto& theirs = axes[0].overrides.emplace_back();
      theirs.whose = whose;
      theirs.travel_maximum = millimeters(maximum);
    }
    axes[1].travel_minimum = millimeters(1);
    axes[1].travel_maximum = millimeters(3);
    axes[2].require_homing = true;
  }

  static std::string own_name() { return server::caller_name(::geteuid()); }

  // Returns the reason for which the lines were refused before any was sent; unspecified if they were not.
  v1::Reason refused(const Lines& lines) {
    grpc::ClientContext context;
    limit(context);
    v1::ExecuteRequest request;
    request.set_device("devices/stage");
    for (const std::string& line : lines) request.add_lines(line);
    const auto stream = commands_->Execute(&context, request);
    v1::ExecuteResponse response;
    bool sent = false;
    while (stream->Read(&response)) sent = true;
    const grpc::Status status = stream->Finish();
    EXPECT_NE(sent, !status.ok()) << lines.front() << ": " << status.error_message();
    return reason(status);
  }
};

TEST_F(RpcEnvelope, ACallerAndARoleHaveOverrides) {
  grpc::Status status = move(move_request(1, "2.5"));
  EXPECT_EQ(reason(status), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_THAT(status.error_message(), HasSubstr("beyond its travel maximum of 2000um for " + own_name()));

  const server::Calendar now = server::calendar_now();
  const auto token = access_->tokens().create("guest", server::Role::operator_, now + std::chrono::hours(1), now);
  ASSERT_TRUE(token) << token.error().message;
  const auto move_as_guest = [&](const char* mm) {
    grpc::ClientContext context;
    limit(context);
    context.AddMetadata("authorization", "Bearer " + *token);
    v1::MoveRequest request = move_request(1, mm);
    request.set_validate_only(true);
    v1::MoveResponse response;
    return stage_->Move(&context, request, &response);
  };
  EXPECT_TRUE(move_as_guest("2.5").ok());
  status = move_as_guest("3.5");
  EXPECT_EQ(reason(status), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_THAT(status.error_message(), HasSubstr("beyond its travel maximum of 3000um for operator"));
}

TEST_F(RpcEnvelope, LinesEndWithinTheTravel) {
  for (const Lines& lines :
       {Lines{"M:1+P200001", "G:1"}, Lines{"M:1-M5.1", "G:1"}, Lines{"A:1+U2001", "G:1"}, Lines{"MP:1+M2.1", "G:1"},
        Lines{"AP:1-P500001", "G:1"}, Lines{"MP:1+P150000", "G:1", "MP:1+P60000"}}) {
    EXPECT_EQ(refused(lines), v1::REASON_OUTSIDE_TRAVEL) << lines[0];
  }
  EXPECT_EQ(refused({"MP:1+P1000", "G:1"}), v1::REASON_UNSPECIFIED);
}

TEST_F(RpcEnvelope, LinesAreNoFasterThanAllowed) {
  for (const Lines& lines :
       {Lines{"D:1S100F999999R100", "M:1+P1", "G:1"}, Lines{"MP:1+P1,S100F60001R100", "G:1"},
        Lines{"AP:1+P1,S100F60001R100", "G:1"}, Lines{"MP:1+P1", "G:1", "MP:1+P1,S100F60001R100"}}) {
    EXPECT_EQ(refused(lines), v1::REASON_TOO_FAST) << lines[0];
  }
  EXPECT_EQ(refused({"MP:1+P1,S100F60000R100", "G:1"}), v1::REASON_UNSPECIFIED);
}

// F stays in the controller, for motions that set none.
TEST_F(RpcEnvelope, ASpeedIsCheckedWhereNothingMoves) {
  EXPECT_EQ(refused({"D:1S100F999999R100"}), v1::REASON_TOO_FAST);
  EXPECT_EQ(refused({"D:1S100F60000R100"}), v1::REASON_UNSPECIFIED);
}

// Manual 68): 601 um/s are 60,100 pulses/s.
TEST_F(RpcEnvelope, SpeedsAreInTheUnitOfTheirWay) {
  EXPECT_EQ(refused({"MP:1+U10,S100F601R100", "G:1"}), v1::REASON_TOO_FAST);
  EXPECT_EQ(refused({"AP:1+M0.01,S0.1F0.7R100", "G:1"}), v1::REASON_TOO_FAST);
}

// A start executes the last setting, from the present position of the axis: manual section 2.
TEST_F(RpcEnvelope, SettingsThatMayChainAreRefused) {
  EXPECT_EQ(refused({"MP:1+P10", "G:1", "MP:1+P10", "MP:1+P10", "G:1"}), v1::REASON_INVALID_REQUEST);
}

TEST_F(RpcEnvelope, ASettingReplacesTheOneBefore) {
  EXPECT_EQ(refused({"M:1-P190000", "M:1+P300000", "G:1"}), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_EQ(refused({"M:1-P190000", "GC:1", "M:1+P300000", "G:1"}), v1::REASON_OUTSIDE_TRAVEL);
}

TEST_F(RpcEnvelope, TheLogicalOriginMayLieOutsideTheTravel) {
  EXPECT_EQ(refused({"Z:2"}), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_EQ(refused({"ZRT:2"}), v1::REASON_OUTSIDE_TRAVEL);
  EXPECT_EQ(refused({"MP:1+P1000", "G:1"}), v1::REASON_UNSPECIFIED);
  EXPECT_EQ(refused({"ZRT:1"}), v1::REASON_UNSPECIFIED);
  EXPECT_EQ(refused({"HRT:2"}), v1::REASON_UNSPECIFIED) << "how the axis learns its place";
}

TEST_F(RpcEnvelope, OriginReturnComesFirst) {
  for (const Lines& lines : {Lines{"M:3+P1", "G:3"}, Lines{"ZRT:3"}}) {
    EXPECT_EQ(refused(lines), v1::REASON_NOT_HOMED) << lines[0];
  }
  grpc::ClientContext context;
  limit(context);
  v1::HomeRequest request;
  request.set_device("devices/stage");
  request.add_axes("3");
  v1::HomeResponse response;
  ASSERT_TRUE(stage_->Home(&context, request, &response).ok());
  EXPECT_EQ(outcome(response.motion().name()).state(), v1::MOTION_STATE_SUCCEEDED);
  EXPECT_EQ(refused({"MP:3+P1", "G:3"}), v1::REASON_UNSPECIFIED);
}

TEST_F(RpcEnvelope, ADeviceTellsWhichAxesAreHomedFirst) {
  grpc::ClientContext context;
  limit(context);
  v1::GetDeviceRequest request;
  request.set_device("devices/stage");
  v1::GetDeviceResponse response;
  ASSERT_TRUE(devices_->GetDevice(&context, request, &response).ok());
  EXPECT_FALSE(response.device().axes(0).require_homing());
  EXPECT_TRUE(response.device().axes(2).require_homing());
}

}  // namespace
}  // namespace axisgate::rpc
