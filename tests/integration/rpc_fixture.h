// A whole gateway inside the test: built-in simulator, services, and a client on its Unix socket.
#pragma once

#include <google/rpc/status.pb.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "axisgate/v1/access.grpc.pb.h"
#include "axisgate/v1/command.grpc.pb.h"
#include "axisgate/v1/control.grpc.pb.h"
#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/diagnostics.grpc.pb.h"
#include "axisgate/v1/event.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "server/access/access.h"
#include "server/connections/callers.h"
#include "server/devices/saved_positions.h"
#include "server/doors/doors.h"
#include "server/events/wall_time.h"
#include "server/gateway.h"
#include "server/kinds.h"

namespace axisgate::rpc {

class RpcTest : public ::testing::Test {
 protected:
  void SetUp() override {
    server::Config config = server::default_config(server::device_kinds());
    config.listen.port = 0;
    config.socket = directory_ + "/axisgate.sock";
    config.devices[0].connection = server::SimulatedConnection{20, false, {}};
    std::get<server::StageConfig>(config.devices[0].family).profile.axes[0].travel_maximum =
        Quantity{{5, 0}, Unit::millimeters};
    configure(config);
    gateway_ = std::make_unique<server::Gateway>(config, 1, "", journal_.get(), spool_.get());
    access_ = std::make_unique<server::Access>(config.access, server::caller_name(::geteuid()),
                                               *server::Tokens::open(directory_ + ".tokens"));
    positions_ = *server::SavedPositions::open(directory_ + ".positions");
    auto started = server::Doors::open(*gateway_, *access_, *positions_, limits_);
    ASSERT_TRUE(started) << started.error().message;
    doors_ = *std::move(started);
    gateway_->start();
    channel_ = grpc::CreateChannel("unix:" + config.socket, grpc::InsecureChannelCredentials());
    devices_ = v1::DeviceService::NewStub(channel_);
    stage_ = v1::StageService::NewStub(channel_);
    events_ = v1::EventService::NewStub(channel_);
    commands_ = v1::CommandService::NewStub(channel_);
    diagnostics_ = v1::DiagnosticsService::NewStub(channel_);
    control_ = v1::ControlService::NewStub(channel_);
    wait_until_up();
  }

  // Changes the configuration for a test.
  virtual void configure(server::Config&) {}

  void TearDown() override {
    doors_.reset();
    gateway_.reset();
    std::filesystem::remove(directory_ + ".tokens");
    std::filesystem::remove(directory_ + ".positions");
    std::filesystem::remove(directory_);
  }

  // Limits every call in these tests to a time that suffices on a slow machine, so that a hang fails.
  static void limit(grpc::ClientContext& context) {
    context.set_deadline(server::to_wall(monotonic_now() + std::chrono::seconds(30)));
  }

  void wait_until_up() {
    grpc::ClientContext context;
    limit(context);
    v1::WatchDeviceRequest request;
    request.set_device("devices/stage");
    const auto stream = devices_->WatchDevice(&context, request);
    v1::WatchDeviceResponse response;
    while (stream->Read(&response)) {
      if (response.device().link() == v1::LINK_STATE_UP) break;
    }
    ASSERT_EQ(response.device().link(), v1::LINK_STATE_UP);
    context.TryCancel();
  }

  static v1::MoveRequest move_request(int axis, const std::string& mm) {
    v1::MoveRequest request;
    request.set_device("devices/stage");
    v1::AxisTarget& target = *request.add_targets();
    target.set_axis(std::to_string(axis));
    target.mutable_distance()->set_mm(mm);
    return request;
  }

  grpc::Status move(const v1::MoveRequest& request, v1::Motion* motion = nullptr) {
    grpc::ClientContext context;
    limit(context);
    v1::MoveResponse response;
    const grpc::Status status = stage_->Move(&context, request, &response);
    if (motion != nullptr) *motion = response.motion();
    return status;
  }

  // The motion at its outcome.
  v1::Motion outcome(const std::string& name) {
    grpc::ClientContext context;
    limit(context);
    v1::WatchMotionRequest request;
    request.set_motion(name);
    const auto stream = stage_->WatchMotion(&context, request);
    v1::WatchMotionResponse response;
    while (stream->Read(&response)) {
    }
    EXPECT_TRUE(stream->Finish().ok());
    return response.motion();
  }

  v1::Motion motion_now(const std::string& name) {
    grpc::ClientContext context;
    limit(context);
    v1::GetMotionRequest request;
    request.set_motion(name);
    v1::GetMotionResponse response;
    EXPECT_TRUE(stage_->GetMotion(&context, request, &response).ok());
    return response.motion();
  }
  int motion_count() {
    grpc::ClientContext context;
    limit(context);
    v1::ListMotionsRequest request;
    request.set_device("devices/stage");
    v1::ListMotionsResponse response;
    EXPECT_TRUE(stage_->ListMotions(&context, request, &response).ok());
    return response.motions_size();
  }

  // On a connection of its own.
  std::shared_ptr<grpc::Channel> new_channel() const {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel("unix:" + directory_ + "/axisgate.sock", grpc::InsecureChannelCredentials(),
                                     arguments);
  }

  // An empty request to a method of whatever kind.
  static grpc::Status call(const std::shared_ptr<grpc::Channel>& channel, const std::string& method) {
    grpc::ClientContext context;
    limit(context);
    return call(channel, method, context);
  }
  static grpc::Status call(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                           grpc::ClientContext& context) {
    grpc::GenericStub stub(channel);
    grpc::CompletionQueue queue;
    const grpc::Slice nothing;
    const grpc::ByteBuffer request(&nothing, 1);
    const auto reader = stub.PrepareUnaryCall(&context, method, request, &queue);
    grpc::ByteBuffer response;
    grpc::Status status;
    reader->StartCall();
    reader->Finish(&response, &status, nullptr);
    void* tag = nullptr;
    bool ok = false;
    queue.Next(&tag, &ok);
    queue.Shutdown();
    while (queue.Next(&tag, &ok)) {
    }
    return status;
  }

  static v1::Problem problem(const grpc::Status& status) {
    google::rpc::Status details;
    v1::Problem problem;
    if (!details.ParseFromString(status.error_details()) || details.details_size() == 0) return problem;
    problem.ParseFromString(details.details(0).value());
    return problem;
  }
  static v1::Reason reason(const grpc::Status& status) { return problem(status).reason(); }

  server::ConnectionLimits limits_{100};  // before SetUp()
  const std::string directory_ = ::testing::TempDir() + "axisgate-rpc-" + std::to_string(::getpid());
  std::unique_ptr<server::journal::Journal> journal_;  // before SetUp(); null: none is kept
  std::unique_ptr<server::spool::Spool> spool_;        // before SetUp(); null: there are no mills
  std::unique_ptr<server::Access> access_;
  std::unique_ptr<server::SavedPositions> positions_;
  std::unique_ptr<server::Gateway> gateway_;
  std::unique_ptr<server::Doors> doors_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::DeviceService::Stub> devices_;
  std::unique_ptr<v1::StageService::Stub> stage_;
  std::unique_ptr<v1::EventService::Stub> events_;
  std::unique_ptr<v1::CommandService::Stub> commands_;
  std::unique_ptr<v1::DiagnosticsService::Stub> diagnostics_;
  std::unique_ptr<v1::ControlService::Stub> control_;
};

}  // namespace axisgate::rpc
