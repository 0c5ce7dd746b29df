// Tests of the calls that a connection is served if no place is left when it comes.
#include <google/protobuf/descriptor.h>

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

class ReserveTest : public RpcTest {
 protected:
  // The fixture's own channel takes the only place.
  ReserveTest() { limits_.open = 1; }

  static grpc::Status get_device(const std::shared_ptr<grpc::Channel>& channel) {
    grpc::ClientContext context;
    limit(context);
    v1::GetDeviceRequest request;
    request.set_device("devices/stage");
    v1::GetDeviceResponse response;
    return v1::DeviceService::NewStub(channel)->GetDevice(&context, request, &response);
  }
};

std::vector<std::string> methods_of_the_api() {
  std::vector<std::string> methods;
  for (const google::protobuf::Message* request : std::initializer_list<const google::protobuf::Message*>{
           &v1::ListDevicesRequest::default_instance(), &v1::MoveRequest::default_instance(),
           &v1::WatchRequest::default_instance(), &v1::ExecuteRequest::default_instance(),
           &v1::RecordRequest::default_instance()}) {
    const google::protobuf::FileDescriptor* file = request->GetDescriptor()->file();
    for (int i = 0; i < file->service_count(); ++i) {
      for (int k = 0; k < file->service(i)->method_count(); ++k) {
        methods.push_back("/" + file->service(i)->full_name() + "/" + file->service(i)->method(k)->name());
      }
    }
  }
  return methods;
}

TEST_F(ReserveTest, StopsAreServedAndEverythingElseIsRefused) {
  const std::map<std::string, grpc::StatusCode> served = {
      // An empty stop is one of all devices.
      {"/axisgate.v1.StageService/Stop", grpc::OK},
      {"/axisgate.v1.StageService/EmergencyStop", grpc::OK},
      {"/axisgate.v1.DeviceService/ListDevices", grpc::OK},
  };
  std::set<std::string> seen;
  for (const std::string& method : methods_of_the_api()) {
    SCOPED_TRACE(method);
    const grpc::Status status = call(new_channel(), method);
    if (const auto expected = served.find(method); expected != served.end()) {
      EXPECT_EQ(status.error_code(), expected->second);
      seen.insert(method);
    } else {
      EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
      EXPECT_EQ(reason(status), v1::REASON_QUEUE_FULL);
    }
  }
  EXPECT_EQ(seen.size(), served.size());
  EXPECT_EQ(call(new_channel(), "/grpc.health.v1.Health/Check").error_code(), grpc::RESOURCE_EXHAUSTED);
}

TEST_F(ReserveTest, AStopEndsTheMotionOfAnother) {
  v1::Motion motion;
  v1::MoveRequest request = move_request(1, "4.9");
  request.mutable_targets(0)->mutable_profile()->mutable_maximum()->set_mm_per_s("0.1");
  ASSERT_TRUE(move(request, &motion).ok());
  grpc::ClientContext context;
  limit(context);
  v1::StopRequest stop;
  stop.set_device("devices/stage");
  v1::StopResponse response;
  const grpc::Status status = v1::StageService::NewStub(new_channel())->Stop(&context, stop, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(outcome(motion.name()).state(), v1::MOTION_STATE_STOPPED);
}

TEST_F(ReserveTest, AClientThatWasRefusedIsServedOnceThereIsAPlace) {
  const auto waiting = new_channel();
  EXPECT_EQ(get_device(waiting).error_code(), grpc::RESOURCE_EXHAUSTED);
  devices_.reset();
  stage_.reset();
  events_.reset();
  commands_.reset();
  diagnostics_.reset();
  control_.reset();
  channel_.reset();
  // It asks again and again, so that its connection is never idle.
  const TimePoint limit = monotonic_now() + std::chrono::seconds(30);
  while (!get_device(waiting).ok()) {
    ASSERT_LT(monotonic_now(), limit);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(doors_->connections().open, 1u);
}

}  // namespace
}  // namespace axisgate::rpc
