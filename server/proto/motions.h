// Conversion of motions to callers' messages.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "axisgate/v1/motion.pb.h"
#include "axisgate/v1/stage.pb.h"
#include "device/stage/event.h"
#include "device/stage/motion.h"
#include "server/api/request/motion_watch.h"
#include "server/events/wall_time.h"
#include "server/proto/shown.h"

namespace axisgate::proto {

// `shown` is that of the stage whose axis it is.
v1::AxisResult to_proto(const stage::AxisResult& result, const Shown& shown);

// `revision` is that of the newest fact about the motion, 0 if unknown. `clock` converts the motion's times to wall
// time. `shown` is that of the motion's stage.
v1::Motion to_proto(std::string_view device, const stage::Motion& motion, std::uint64_t revision,
                    const server::Moment& clock, const Shown& shown);
v1::Motion to_proto(const api::CurrentMotion& motion);

// Fills the page that `request` asks for from all motions of its device.
void fill_page(const v1::ListMotionsRequest& request, std::vector<api::CurrentMotion> motions,
               v1::ListMotionsResponse& response);

v1::PathProgress to_proto(std::string_view device, const stage::PathProgress& progress);

}  // namespace axisgate::proto
