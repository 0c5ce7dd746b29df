// Tests of a caller at the limit of open calls, and of the other callers.
#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Channel = std::shared_ptr<grpc::Channel>;

// The state of the device at every change, until it goes.
class OpenStream {
 public:
  OpenStream(const Channel& channel, const std::string& authorization) : devices_(v1::DeviceService::NewStub(channel)) {
    context_.set_deadline(server::to_wall(monotonic_now() + std::chrono::seconds(60)));
    if (!authorization.empty()) context_.AddMetadata("authorization", authorization);
    v1::WatchDeviceRequest request;
    request.set_device("devices/stage");
    reader_ = devices_->WatchDevice(&context_, request);
    v1::WatchDeviceResponse response;
    if (!reader_->Read(&response)) refusal_ = reader_->Finish();
  }
  ~OpenStream() { context_.TryCancel(); }

  const grpc::Status& refusal() const { return refusal_; }  // OK: it was let in

 private:
  const std::unique_ptr<v1::DeviceService::Stub> devices_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::WatchDeviceResponse>> reader_;
  grpc::Status refusal_;
};

// Waits for axis 1 until it goes.
class WaitingCall {
 public:
  explicit WaitingCall(v1::ControlService::Stub& control) {
    context_.set_deadline(server::to_wall(monotonic_now() + std::chrono::seconds(60)));
    v1::AcquireLeaseRequest request;
    request.set_device("devices/stage");
    request.mutable_terms()->add_axes("1");
    request.mutable_wait()->set_seconds(60);
    thread_ = std::thread([this, &control, request] {
      v1::AcquireLeaseResponse response;
      control.AcquireLease(&context_, request, &response);
    });
  }
  ~WaitingCall() {
    context_.TryCancel();
    thread_.join();
  }

 private:
  grpc::ClientContext context_;
  std::thread thread_;
};

class RpcLimits : public RpcTest {
 protected:
  void configure(server::Config& config) override {
    config.limits.streams = 2;
    config.limits.calls = 2;
    config.limits.message_bytes = 4096;
  }

  std::string token(const std::string& name) {
    const server::Calendar now = server::calendar_now();
    const auto made = access_->tokens().create(name, server::Role::operator_, now + std::chrono::hours(1), now);
    EXPECT_TRUE(made) << made.error().message;
    return "Bearer " + made.value_or("");
  }

  Channel loopback() const {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel(to_string(doors_->listen()), grpc::InsecureChannelCredentials(), arguments);
  }

  template <class Condition>
  static bool wait_until(Condition condition) {
    const TimePoint limit = monotonic_now() + std::chrono::seconds(30);
    while (!condition()) {
      if (monotonic_now() > limit) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // between two looks
    }
    return true;
  }

  // Opens a stream as soon as there is a place: a stream that its reader has left keeps its place for a moment.
  static std::unique_ptr<OpenStream> stream(const Channel& channel, const std::string& authorization = "") {
    std::unique_ptr<OpenStream> made;
    const auto let_in = [&] {
      made = std::make_unique<OpenStream>(channel, authorization);
      return made->refusal().ok();
    };
    EXPECT_TRUE(wait_until(let_in)) << made->refusal().error_message();
    return made;
  }

  static grpc::Status ask(const Channel& channel, const std::string& method, const std::string& authorization = "") {
    grpc::ClientContext context;
    limit(context);
    if (!authorization.empty()) context.AddMetadata("authorization", authorization);
    return call(channel, method, context);
  }

  // An empty stop names no device: it is one of all.
  static void expect_stops_get_through(const Channel& channel) {
    for (const char* method : {"Stop", "EmergencyStop"}) {
      const grpc::Status status = ask(channel, std::string("/axisgate.v1.StageService/") + method);
      EXPECT_TRUE(status.ok()) << method << ": " << status.error_message();
    }
    EXPECT_TRUE(ask(channel, "/axisgate.v1.DeviceService/ListDevices").ok());
  }
  static grpc::Status stop(const Channel& channel) {
    grpc::ClientContext context;
    limit(context);
    v1::StopRequest request;
    request.set_device("devices/stage");
    v1::StopResponse response;
    return v1::StageService::NewStub(channel)->Stop(&context, request, &response);
  }

  v1::MotionState state(const std::string& motion) {
    grpc::ClientContext context;
    limit(context);
    v1::GetMotionRequest request;
    request.set_motion(motion);
    v1::GetMotionResponse response;
    stage_->GetMotion(&context, request, &response);
    return response.motion().state();
  }

  // Until that many wait for axes.
  void wait_for_waiting(int count) {
    grpc::ClientContext context;
    limit(context);
    v1::WatchLeasesRequest request;
    request.set_device("devices/stage");
    const auto stream = control_->WatchLeases(&context, request);
    v1::WatchLeasesResponse board;
    while (stream->Read(&board) && board.waiting_size() != count) continue;
    EXPECT_EQ(board.waiting_size(), count);
    context.TryCancel();
  }

  const std::string me_ = server::caller_name(::geteuid());
};

TEST_F(RpcLimits, AStreamTooManyIsRefusedWhicheverConnectionItComesBy) {
  const std::array open = {stream(channel_), stream(new_channel())};
  for (const Channel& channel : {channel_, new_channel()}) {
    const OpenStream refused(channel, "");
    EXPECT_EQ(refused.refusal().error_code(), grpc::RESOURCE_EXHAUSTED);
    EXPECT_EQ(refused.refusal().error_message(), me_ + " has 2 streams open, as many as one caller may have");
    EXPECT_THAT(problem(refused.refusal()).hint(), AllOf(HasSubstr("close some"), HasSubstr("try again in 1 s")));
  }
  EXPECT_EQ(ask(channel_, "/grpc.health.v1.Health/Watch").error_code(), grpc::RESOURCE_EXHAUSTED);
}

TEST_F(RpcLimits, WithTooManyStreamsAStopGetsThroughAndOthersAreServed) {
  v1::Motion motion;
  v1::MoveRequest request = move_request(1, "4.9");
  request.mutable_targets(0)->mutable_profile()->mutable_maximum()->set_mm_per_s("0.1");
  ASSERT_TRUE(move(request, &motion).ok());
  const std::array open = {stream(channel_), stream(channel_)};
  ASSERT_EQ(OpenStream(channel_, "").refusal().error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(stop(channel_).ok());
  EXPECT_TRUE(wait_until([&] { return state(motion.name()) == v1::MOTION_STATE_STOPPED; }));
  EXPECT_TRUE(OpenStream(channel_, token("night-scan")).refusal().ok());
  EXPECT_TRUE(OpenStream(loopback(), "").refusal().ok());
  expect_stops_get_through(channel_);
}

TEST_F(RpcLimits, AStreamThatEndsLeavesItsPlace) {
  std::array open = {stream(channel_), stream(channel_)};
  ASSERT_EQ(OpenStream(channel_, "").refusal().error_code(), grpc::RESOURCE_EXHAUSTED);
  open[0].reset();
  open[0] = stream(channel_);
  EXPECT_EQ(OpenStream(channel_, "").refusal().error_code(), grpc::RESOURCE_EXHAUSTED);
}

TEST_F(RpcLimits, ARequestTooManyIsRefusedAndAStopIsNot) {
  const std::string another = token("night-scan");
  grpc::ClientContext context;
  limit(context);
  context.AddMetadata("authorization", another);
  v1::AcquireLeaseRequest all;
  all.set_device("devices/stage");
  all.mutable_terms()->mutable_time_to_live()->set_seconds(60);
  v1::AcquireLeaseResponse lease;
  ASSERT_TRUE(control_->AcquireLease(&context, all, &lease).ok());
  const auto first = std::make_unique<WaitingCall>(*control_);
  auto second = std::make_unique<WaitingCall>(*control_);
  wait_for_waiting(2);

  const grpc::Status refused = ask(channel_, "/axisgate.v1.AccessService/GetCaller");
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(refused.error_message(), me_ + " has 2 requests in flight, as many as one caller may have");
  EXPECT_THAT(problem(refused).hint(), AllOf(HasSubstr("wait for some of them"), HasSubstr("try again in 1 s")));
  EXPECT_EQ(ask(channel_, "/grpc.health.v1.Health/Check").error_code(), grpc::RESOURCE_EXHAUSTED);
  expect_stops_get_through(channel_);
  EXPECT_TRUE(ask(channel_, "/axisgate.v1.AccessService/GetCaller", another).ok());
  second.reset();
  EXPECT_TRUE(wait_until([&] { return ask(channel_, "/axisgate.v1.AccessService/GetCaller").ok(); }));
}

// Each could come from another port, or from another address of the loopback network.
TEST_F(RpcLimits, WhoComesNamelessSharesTheLimit) {
  const std::array open = {stream(loopback()), stream(loopback())};
  const OpenStream refused(loopback(), "");
  EXPECT_EQ(refused.refusal().error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(refused.refusal().error_message(), HasSubstr("a caller over TCP has 2 streams open"));
  expect_stops_get_through(loopback());
  EXPECT_TRUE(OpenStream(loopback(), token("night-scan")).refusal().ok());
}

TEST_F(RpcLimits, AMessageTooLargeIsRefused) {
  v1::MoveRequest request = move_request(1, "1");
  request.mutable_context()->set_request_id(std::string(3000, 'x'));
  EXPECT_EQ(move(request).error_code(), grpc::INVALID_ARGUMENT);  // read, and found too long an id
  request.mutable_context()->set_request_id(std::string(5000, 'x'));
  const grpc::Status refused = move(request);
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(refused.error_message(), HasSubstr("the daemon takes 4096 at most"));
}

class ConnectionLimitsTest : public RpcLimits {
 protected:
  // The fixture's own channel takes this user's only place.
  ConnectionLimitsTest() { limits_.of_one = 1; }
};

TEST_F(ConnectionLimitsTest, AConnectionTooManyIsServedAStopOnly) {
  const Channel second = new_channel();
  const grpc::Status refused = ask(second, "/axisgate.v1.AccessService/GetCaller");
  EXPECT_EQ(reason(refused), v1::REASON_QUEUE_FULL);
  EXPECT_THAT(refused.error_message(), HasSubstr("this caller has too many open"));
  EXPECT_THAT(problem(refused).hint(), HasSubstr("connect again in 1 s"));
  expect_stops_get_through(new_channel());
  const Channel elsewhere = loopback();
  EXPECT_TRUE(ask(elsewhere, "/axisgate.v1.AccessService/GetCaller").ok());
  EXPECT_EQ(doors_->connections().open, 2u);
}

}  // namespace
}  // namespace axisgate::rpc
