// Saving a position under a name, and removing one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/kind.h"
#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/api/stage/positions.h"
#include "server/devices/saved_positions.h"
#include "server/gateway.h"

namespace axisgate::api {

// A Saving is kept by its callbacks until it has answered.
struct Saving {
  server::Gateway& gateway;
  server::SavedPositions& positions;
  const stage::Kind& kind;
  stage::PositionLines lines;
  server::SavedPosition position;
  server::SavedPositions::Number number;        // reserved until the saving has ended
  std::optional<server::SavedPosition> before;  // position that had the name before
  Answer<std::optional<NamedPosition>> answer{};
  std::vector<std::string> answers{};  // of the controller, to SET, GET and GET
};
void begin(Saving saving, const Turn& turn);

// A Removal is kept by its callbacks until it has answered.
struct Removal {
  server::Gateway& gateway;
  server::SavedPositions& positions;
  server::SavedPosition position;
  Answer<void> answer;
};
void begin(Removal removal, const Turn& turn);

}  // namespace axisgate::api
