// Messages that are not what their method takes, in calls that gRPC serves and in those that the front answers.
#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/rpc/services.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using testing::Contains;
using testing::HasSubstr;

// A field begins, and its number does not end.
const std::string kUnreadable = "\xff";

class UnreadableTest : public RpcTest {
 protected:
  // Sends these messages, and no more.
  grpc::Status send(const std::string& method, const std::vector<std::string>& messages) {
    grpc::GenericStub stub(channel_);
    grpc::CompletionQueue queue;
    grpc::ClientContext context;
    limit(context);
    const auto done = [&queue] {
      void* tag = nullptr;
      bool ok = false;
      queue.Next(&tag, &ok);
      return ok;
    };
    const auto call = stub.PrepareCall(&context, method, &queue);
    call->StartCall(nullptr);
    done();
    for (const std::string& message : messages) {
      const grpc::Slice slice(message);
      call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
      if (!done()) break;
    }
    call->WritesDone(nullptr);
    done();
    grpc::ByteBuffer response;
    do {
      call->Read(&response, nullptr);
    } while (done());
    grpc::Status status;
    call->Finish(&status, nullptr);
    done();
    queue.Shutdown();
    return status;
  }

  static void expect_explained(const grpc::Status& status, const std::string& method) {
    EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT) << method << ": " << status.error_message();
    EXPECT_EQ(status.error_message(), "the message is not one of " + method);
    EXPECT_EQ(reason(status), v1::REASON_INVALID_REQUEST) << method;
  }

  static std::string path_header() {
    v1::RunPathRequest request;
    request.mutable_header()->set_device("devices/stage");
    return request.SerializeAsString();
  }
  static std::string path_segment() {
    v1::RunPathRequest request;
    v1::AxisDistance& move = *request.mutable_segment()->mutable_single();
    move.set_axis("1");
    move.mutable_distance()->set_pulses(100);
    return request.SerializeAsString();
  }
};

TEST_F(UnreadableTest, EveryMethodSaysSo) {
  std::vector<std::string> methods;
  for (const ServedMethod& method : served_methods()) {
    if (!method.name.starts_with("axisgate.v1.")) continue;
    methods.push_back("/" + method.name);
    // ListDevices takes nothing that could be wrong.
    if (method.name == "axisgate.v1.DeviceService/ListDevices") continue;
    expect_explained(send(methods.back(), {kUnreadable}), methods.back());
  }
  for (const char* method : {"/axisgate.v1.StageService/Move", "/axisgate.v1.EventService/Watch",
                             "/axisgate.v1.StageService/Jog", "/axisgate.v1.StageService/Stop"}) {
    EXPECT_THAT(methods, Contains(method));
  }
}

TEST_F(UnreadableTest, WhatIsNotOneMessageIsRefusedByMethodsThatTheFrontAnswers) {
  const std::string method = "/axisgate.v1.StageService/Stop";
  for (const std::vector<std::string>& messages : {std::vector<std::string>{}, {"", ""}}) {
    const grpc::Status status = send(method, messages);
    EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT) << messages.size();
    EXPECT_THAT(status.error_message(), HasSubstr("must hold exactly one whole message of " + method));
    EXPECT_EQ(reason(status), v1::REASON_INVALID_REQUEST);
  }
}

// To end its reading is all that gRPC does about it, as at the end of a path.
TEST_F(UnreadableTest, HalfAPathDoesNotRun) {
  const std::string method = "/axisgate.v1.StageService/RunPath";
  expect_explained(send(method, {path_header(), path_segment(), kUnreadable, path_segment()}), method);
  EXPECT_EQ(motion_count(), 0);
  EXPECT_TRUE(send(method, {path_header(), path_segment()}).ok());
  EXPECT_EQ(motion_count(), 1);
}

TEST_F(UnreadableTest, AJogIsStoppedAndSaysWhy) {
  v1::JogRequest first;
  first.set_device("devices/stage");
  v1::AxisJog& axis = *first.add_axes();
  axis.set_axis("1");
  axis.set_direction(v1::AxisJog::DIRECTION_PLUS);
  const std::string method = "/axisgate.v1.StageService/Jog";
  const grpc::Status ended = send(method, {first.SerializeAsString(), kUnreadable});
  expect_explained(ended, method);
  ASSERT_EQ(motion_count(), 1);
  EXPECT_EQ(outcome("devices/stage/motions/1").state(), v1::MOTION_STATE_STOPPED);
}

TEST_F(UnreadableTest, ItIsCountedAsWhatItsCallerReceives) {
  send("/axisgate.v1.StageService/Move", {kUnreadable});
  bool counted = false;
  for (const prometheus::MetricFamily& family : gateway_->metrics().registry()->Collect()) {
    if (family.name != "axisgate_rpcs_total") continue;
    for (const prometheus::ClientMetric& metric : family.metric) {
      std::string labels;
      for (const auto& label : metric.label) labels += label.name + "=" + label.value + " ";
      counted = counted || (labels.find("code=INVALID_ARGUMENT") != std::string::npos && metric.counter.value == 1);
      EXPECT_THAT(labels, testing::Not(HasSubstr("UNIMPLEMENTED")));
    }
  }
  EXPECT_TRUE(counted);
}

}  // namespace
}  // namespace axisgate::rpc
