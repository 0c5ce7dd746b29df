// Conversion of devices, motions and facts to callers' messages.
#pragma once

#include <google/protobuf/timestamp.pb.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/event.pb.h"
#include "axisgate/v1/stage.pb.h"
#include "device/stage/stage_controller.h"
#include "server/api/stage/stops.h"
#include "server/devices/stage.h"
#include "server/events/event_bus.h"
#include "server/events/wall_time.h"
#include "server/proto/shown.h"

namespace axisgate::proto {

google::protobuf::Timestamp to_proto(server::WallTime time);

void fill_trigger(const stage::Trigger& trigger, v1::Trigger& proto);

// Includes the age of the state at the time of the call.
v1::Device to_proto(const server::Stage& device, const stage::State& state);

v1::Condition to_condition(stage::Condition condition);

// `stage` is that of the record; null if the record is of another device or none.
v1::Event to_proto(const server::FactRecord& record, const server::Stage* stage);

v1::DeviceStop to_proto(const api::DeviceStop& stop);

}  // namespace axisgate::proto
