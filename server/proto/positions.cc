#include "server/proto/positions.h"

#include <fmt/format.h>

#include "server/events/wall_time.h"
#include "server/proto/callers.h"
#include "server/proto/to_proto.h"

namespace axisgate::proto {

Result<api::PositionWish> to_wish(const v1::SavePositionRequest& request) {
  const v1::PositionKind kind = request.kind();
  if (kind != v1::POSITION_KIND_UNSPECIFIED && kind != v1::POSITION_KIND_PLACE &&
      kind != v1::POSITION_KIND_COORDINATES) {
    return fail(Reason::invalid_request, fmt::format("there is no kind {} of positions", static_cast<int>(kind)));
  }
  return api::PositionWish{.place = kind != v1::POSITION_KIND_COORDINATES, .keep_existing = request.keep_existing()};
}

v1::Position to_proto(const api::NamedPosition& named, const Shown& shown) {
  const server::SavedPosition& position = named.position;
  v1::Position proto;
  proto.set_name(api::position_name(position.device, position.name));
  proto.set_kind(position.place ? v1::POSITION_KIND_PLACE : v1::POSITION_KIND_COORDINATES);
  proto.set_number(position.number);
  for (const auto& [axis, pulses] : position.coordinates) {
    v1::PositionCoordinate& coordinate = *proto.add_coordinates();
    coordinate.set_axis(axis);
    coordinate.set_pulses(pulses);
    shown.describe(axis, coordinate);
    coordinate.set_position(shown.text(axis, pulses));
  }
  *proto.mutable_save_time() = to_proto(server::WallTime(position.saved));
  *proto.mutable_caller() = to_caller(position.who);
  proto.set_emptied(named.emptied);
  return proto;
}

}  // namespace axisgate::proto
