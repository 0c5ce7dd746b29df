// Axes that a stage may have, but an SHRC-203 does not: every request that names one is refused before anything is
// planned or written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>

#include <map>

#include "axisgate/v1/settings.grpc.pb.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

class AxesBeyond : public RpcTest, public testing::WithParamInterface<int> {
 protected:
  // The request's text with AXIS for the number.
  template <class Request>
  Request request(std::string text) {
    for (std::size_t at; (at = text.find("AXIS")) != std::string::npos;) {
      text.replace(at, 4, std::to_string(GetParam()));
    }
    Request message;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &message)) << text;
    return message;
  }

  template <class Stub, class Request, class Response>
  void refuses(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
               const std::string& text) {
    grpc::ClientContext context;
    limit(context);
    Response response;
    const grpc::Status status = (stub.*method)(&context, request<Request>(text), &response);
    EXPECT_EQ(reason(status), v1::REASON_UNKNOWN_AXIS) << text << ": " << status.error_message();
  }
};
INSTANTIATE_TEST_SUITE_P(Axes, AxesBeyond, testing::Values(4, 8));

TEST_P(AxesBeyond, AreRefusedByEveryUnaryRequest) {
  const std::string device = "device: \"devices/stage\" ";
  using Stage = v1::StageService::Stub;
  refuses(*stage_, &Stage::Move, device + "targets { axis: \"AXIS\" distance { pulses: 5 } }");
  refuses(*stage_, &Stage::Move, device + "targets { axis: \"AXIS\" distance { mm: \"1\" } } relative: true");
  refuses(*stage_, &Stage::Move,
          device + "targets { axis: \"1\" distance { pulses: 5 } } targets { axis: \"AXIS\" distance { pulses: 5 } }");
  refuses(*stage_, &Stage::Move, device + "targets { axis: \"AXIS\" distance { pulses: 5 } approach { pulses: 9 } }");
  refuses(*stage_, &Stage::Home, device + "axes: \"AXIS\"");
  refuses(*stage_, &Stage::Home, device + "axes: \"1\" axes: \"AXIS\"");
  refuses(*stage_, &Stage::ReturnToOrigin, device + "axes: \"AXIS\"");
  refuses(*stage_, &Stage::Scan,
          device + "axis: \"AXIS\" start { pulses: 0 } end { pulses: 900 } distance { pulses: 9 }");
  refuses(*stage_, &Stage::Stop, device + "axes: \"AXIS\"");
  refuses(*stage_, &Stage::Stop, device + "axes: \"2\" axes: \"AXIS\"");
  refuses(*devices_, &v1::DeviceService::Stub::ClearErrors, device + "axes: \"AXIS\"");
  using Control = v1::ControlService::Stub;
  refuses(*control_, &Control::AcquireLease, device + "terms { axes: \"AXIS\" }");
  refuses(*control_, &Control::TakeOverLease, device + "terms { axes: \"1\" axes: \"AXIS\" }");
  const auto settings = v1::SettingService::NewStub(channel_);
  using Settings = v1::SettingService::Stub;
  refuses(*settings, &Settings::ChangeSettings, device + "settings { axes { axis: \"AXIS\" excited: true } }");
  refuses(*settings, &Settings::ChangeSettings,
          device + "settings { trigger { target: TARGET_DRIVE_PULSES axis: \"AXIS\" distance { pulses: 100 } } }");
  refuses(*settings, &Settings::SetCoordinates, device + "coordinates { axis: \"AXIS\" set_origin: true }");
  EXPECT_EQ(motion_count(), 0);
}

TEST_P(AxesBeyond, AreRefusedInAPath) {
  for (const std::string segment :
       {"single { axis: \"AXIS\" distance { pulses: 5 } }",
        "line { distances { axis: \"1\" distance { pulses: 5 } } distances { axis: \"AXIS\" distance { pulses: 5 } } }",
        "arc { around { center { axis: \"1\" distance { pulses: 5 } } center { axis: \"AXIS\" distance { pulses: 0 } } "
        "rotation: ROTATION_CLOCKWISE turns: 1 } }"}) {
    grpc::ClientContext context;
    limit(context);
    const auto stream = stage_->RunPath(&context);
    stream->Write(request<v1::RunPathRequest>("header { device: \"devices/stage\" }"));
    stream->Write(request<v1::RunPathRequest>("segment { relative: true " + segment + " }"));
    stream->WritesDone();
    v1::RunPathResponse response;
    while (stream->Read(&response)) {
    }
    EXPECT_EQ(reason(stream->Finish()), v1::REASON_UNKNOWN_AXIS) << segment;
  }
}

TEST_P(AxesBeyond, AreRefusedByAJog) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = stage_->Jog(&context);
  stream->Write(request<v1::JogRequest>("device: \"devices/stage\" axes { axis: \"AXIS\" direction: DIRECTION_PLUS }"));
  v1::JogResponse response;
  while (stream->Read(&response)) {
  }
  EXPECT_EQ(reason(stream->Finish()), v1::REASON_UNKNOWN_AXIS);
}

}  // namespace
}  // namespace axisgate::rpc
