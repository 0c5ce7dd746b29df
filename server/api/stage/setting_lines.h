// The lines that a change of settings comes to.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/stage/kind.h"
#include "server/api/stage/targets.h"

namespace axisgate::api {

using Lines = std::vector<std::string>;

// Of one axis. What is not given stays.
struct AxisChange {
  int axis = 0;  // any number: what is none is refused
  std::optional<bool> closed_loop{}, excited{};
  std::optional<int> divisions{};
  std::optional<Speeds> speeds{}, origin_speeds{};
  bool names_given = false;  // the axis's own name or scale, which cannot be changed
};

// What is not given stays.
struct SettingsChange {
  std::vector<AxisChange> axes{};
  std::optional<bool> display_lit{}, beep{};
  std::optional<Duration> settling{};
  std::optional<int> outputs{};  // as bits
  std::optional<stage::Trigger> trigger{};
  std::optional<bool> sleeping{};
  std::optional<std::string> mode{}, format{};
  bool inputs_given = false;  // which cannot be changed
};

// What the place where an axis is shall be.
struct SetOrigin {};
struct UnsetOrigin {};
struct NewCoordinate {
  int axis = 0;  // any number: what is none is refused
  // Nothing is refused: it was left open.
  std::optional<std::variant<Quantity, SetOrigin, UnsetOrigin>> coordinate{};
};
using NewCoordinates = std::vector<NewCoordinate>;

// In the order of the manual. unknown_axis, invalid_request, out_of_range, unknown_unit, not_representable; link_down
// where amounts cannot be converted yet.
Result<Lines> lines_of(const SettingsChange& change, const stage::Kind& kind, const stage::State& state);
// Likewise. All axes in the same way.
Result<Lines> lines_of(const NewCoordinates& coordinates, const stage::Kind& kind, const stage::State& state);

}  // namespace axisgate::api
