// A position on its way to a name, and one on its way to none.
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

// Kept by its callbacks until it has answered.
struct Saving {
  server::Gateway& gateway;
  server::SavedPositions& positions;
  const stage::Kind& kind;
  stage::PositionLines lines;
  server::SavedPosition position;
  server::SavedPositions::Number number;        // taken until all is over
  std::optional<server::SavedPosition> before;  // what had the name
  Answer<std::optional<NamedPosition>> answer{};
  std::vector<std::string> answers{};  // to SET, GET and GET
};
void begin(Saving saving, const Turn& turn);

// Likewise.
struct Removal {
  server::Gateway& gateway;
  server::SavedPositions& positions;
  server::SavedPosition position;
  Answer<void> answer;
};
void begin(Removal removal, const Turn& turn);

}  // namespace axisgate::api
