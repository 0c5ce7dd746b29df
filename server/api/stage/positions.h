// Places of a stage with names.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "server/api/request/call.h"
#include "server/api/request/names.h"
#include "server/api/request/pipeline.h"
#include "server/api/stage/motions.h"
#include "server/devices/saved_positions.h"
#include "server/gateway.h"

namespace axisgate::api {

struct PositionWish {
  bool place = true;           // else a set of coordinates
  bool keep_existing = false;  // a name that is there is refused
};

struct NamedPosition {
  server::SavedPosition position;
  bool emptied = false;  // the controller may hold it no more
};

// Thread safe. A position is named as callers name it: "devices/{d}/positions/{name}".
class Positions {
 public:
  // `gateway` and `pipeline` outlive this, and `positions` the gateway.
  Positions(server::Gateway& gateway, const Pipeline& pipeline, server::SavedPositions& positions)
      : gateway_(gateway), pipeline_(pipeline), positions_(positions) {}

  // Where the stage is now. Nothing: it was to be checked only. queue_full, device_refused, link_down, internal.
  void save(const Call& call, std::string_view name, const Result<PositionWish>& wish,
            Answer<std::optional<NamedPosition>> answer) const;
  // Those of a device, by name.
  void list(const Call& call, std::string_view device, Answer<std::vector<NamedPosition>> answer) const;
  // The name, and what the controller holds under it. not_found, and as StageController::check_use() of all axes.
  void remove(const Call& call, std::string_view name, Answer<void> answer) const;
  // not_found; epoch_passed where the controller may hold something else by now.
  void move_to(const Call& call, std::string_view name, Answer<StartedMotion> answer) const;

 private:
  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  server::SavedPositions& positions_;
};

}  // namespace axisgate::api
