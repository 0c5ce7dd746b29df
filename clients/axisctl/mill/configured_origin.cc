#include "clients/axisctl/mill/configured_origin.h"

#include <fmt/format.h>

#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

jobs::Origin configured_origin(const Options& options, const std::string& name) {
  const Session session{options, Connection(options.target, options.request_id)};
  const v1::Mill mill = mill_now(session, chosen_mill(session));
  std::vector<std::string> names;
  for (int i = 0; i < mill.origins_size() && i < mill.origin_places_size(); ++i) {
    const v1::OriginPlace& place = mill.origin_places(i);
    if (mill.origins(i) == name) return {place.x_mm(), place.y_mm(), place.z_mm()};
    names.push_back(mill.origins(i));
  }
  throw usage(fmt::format("{} has no origin \"{}\"", last_part(mill.name()), name),
              names.empty() ? "use three lengths in mm, e.g. 10,10,5.5"
                            : fmt::format("use {}, or three lengths in mm", fmt::join(names, ", ")));
}

}  // namespace axisgate::axisctl
