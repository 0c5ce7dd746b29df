// Command lines that change settings.
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

// An AxisChange changes settings of one axis. Empty members stay unchanged.
struct AxisChange {
  int axis = 0;  // from 1
  std::optional<bool> closed_loop{}, excited{};
  std::optional<int> divisions{};
  std::optional<Speeds> speeds{}, origin_speeds{};
  bool names_given = false;  // name or scale of the axis was given, which cannot be changed
};

// A TriggerWish is a setting of the trigger output whose interval is not converted yet.
struct TriggerWish {
  stage::Trigger::Target target = stage::Trigger::Target::none;
  int axis = 0;                               // 0 for timer and none
  std::variant<Quantity, Duration> interval;  // of scale targets: in scale pulses
};

// A SettingsChange changes settings of a controller. Empty members stay unchanged.
struct SettingsChange {
  std::vector<AxisChange> axes{};
  std::optional<bool> display_lit{}, beep{};
  std::optional<Duration> settling{};
  std::optional<int> outputs{};  // as bits
  std::optional<TriggerWish> trigger{};
  std::optional<bool> sleeping{};
  std::optional<std::string> mode{}, format{};
  bool inputs_given = false;  // inputs were given, which cannot be changed
};

// Alternatives of a NewCoordinate for the present position of an axis.
struct SetOrigin {};
struct UnsetOrigin {};
struct NewCoordinate {
  int axis = 0;  // from 1
  // Left out by the caller if nullopt, which is refused.
  std::optional<std::variant<Quantity, SetOrigin, UnsetOrigin>> coordinate{};
};
using NewCoordinates = std::vector<NewCoordinate>;

// Returns the lines in the order of the manual. Fails with unknown_axis, invalid_request, out_of_range, unknown_unit or
// not_representable, and with link_down if amounts cannot be converted yet.
Result<Lines> lines_of(const SettingsChange& change, const stage::Kind& kind, const stage::State& state);
// Returns the lines for new coordinates. All of them must have the same alternative. Fails like the function above.
Result<Lines> lines_of(const NewCoordinates& coordinates, const stage::Kind& kind, const stage::State& state);

}  // namespace axisgate::api
