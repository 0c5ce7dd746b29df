#include "server/journal/body.h"

#include <utility>

namespace axisgate::server::journal {

using Json = nlohmann::json;

std::string json_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json axes_of(stage::AxisSet axes) {
  Json list = Json::array();
  for (const int axis : axes.list()) list.push_back(axis);
  return list;
}

Json scope_of(use::Scope scope) {
  return scope.is_whole_device() ? Json("device") : axes_of(stage::AxisSet::in(scope));
}

Entry entry_of(Noted noted, std::string device, TimePoint now) {
  return {.kind = noted.kind,
          .time = to_wall(now),
          .boot_time = now,
          .device = std::move(device),
          .who = std::move(noted.who),
          .motion = noted.motion,
          .body = json_text(noted.body)};
}

}  // namespace axisgate::server::journal
