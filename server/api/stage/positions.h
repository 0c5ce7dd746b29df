// Named positions of a stage.
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
  bool place = true;           // false: a set of coordinates
  bool keep_existing = false;  // refuse a name that exists already
};

struct NamedPosition {
  server::SavedPosition position;
  bool emptied = false;  // the controller may have lost the position
};

// Thread safe. Callers name a position "devices/{d}/positions/{name}".
class Positions {
 public:
  // `gateway` and `pipeline` must outlive this object; `positions` must outlive the gateway.
  Positions(server::Gateway& gateway, const Pipeline& pipeline, server::SavedPositions& positions)
      : gateway_(gateway), pipeline_(pipeline), positions_(positions) {}

  // Saves the present position of the stage. Answers with nullopt after a check with validate_only. Fails with
  // queue_full, device_refused, link_down or internal.
  void save(const Call& call, std::string_view name, const Result<PositionWish>& wish,
            Answer<std::optional<NamedPosition>> answer) const;
  // Returns the positions of a device, by name.
  void list(const Call& call, std::string_view device, Answer<std::vector<NamedPosition>> answer) const;
  // Removes the name, and the position in the controller. Fails with not_found, and as StageController::check_use()
  // does for all axes.
  void remove(const Call& call, std::string_view name, Answer<void> answer) const;
  // Fails with not_found, and with epoch_passed if the controller may have another position by now.
  void move_to(const Call& call, std::string_view name, Answer<StartedMotion> answer) const;

 private:
  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  server::SavedPositions& positions_;
};

}  // namespace axisgate::api
