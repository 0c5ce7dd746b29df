// Stubs of the services that the package calls, over one channel.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>

#include "axisgate/v1/access.grpc.pb.h"
#include "axisgate/v1/command.grpc.pb.h"
#include "axisgate/v1/control.grpc.pb.h"
#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/event.grpc.pb.h"
#include "axisgate/v1/position.grpc.pb.h"
#include "axisgate/v1/settings.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"

namespace axisgate::client {

struct Services {
  explicit Services(const std::shared_ptr<grpc::Channel>& over)
      : channel(over),
        access(over),
        commands(over),
        control(over),
        devices(over),
        events(over),
        positions(over),
        settings(over),
        stage(over) {}

  std::shared_ptr<grpc::Channel> channel;
  v1::AccessService::Stub access;
  v1::CommandService::Stub commands;
  v1::ControlService::Stub control;
  v1::DeviceService::Stub devices;
  v1::EventService::Stub events;
  v1::PositionService::Stub positions;
  v1::SettingService::Stub settings;
  v1::StageService::Stub stage;
};

}  // namespace axisgate::client
