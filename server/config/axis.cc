#include "server/config/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "device/core/quantity.h"
#include "server/config/caller.h"
#include "server/config/name.h"
#include "server/config/quantity.h"
#include "server/config/stage.h"

namespace axisgate::server {
namespace {

using stage::AxisLimits;
using stage::AxisProfile;
using stage::LimitOverride;

constexpr std::array<std::string_view, 4> kLimitKeys = {"travel_minimum", "travel_maximum", "maximum_speed",
                                                        "require_homing"};

void read_limits(ConfigTable& table, Unit shown, AxisLimits& limits) {
  read_bounds(table, shown, limits);
  limits.require_homing = table.flag("require_homing").value_or(false);
}

// Reports limits beyond the axis's own, since they would have no effect.
void check_override(ConfigTable& table, const AxisLimits& own, const AxisLimits& theirs) {
  const auto refuse_beyond = [&table](std::string_view key, std::optional<bool> beyond) {
    if (beyond == true) {
      table.error(key, fmt::format("is beyond the axis's own {}, so it would change nothing", key));
    }
  };
  refuse_beyond("travel_minimum", below(theirs.travel_minimum, own.travel_minimum));
  refuse_beyond("travel_maximum", below(own.travel_maximum, theirs.travel_maximum));
  refuse_beyond("maximum_speed", below(own.maximum_speed, theirs.maximum_speed));
  if (below(theirs.travel_minimum, own.travel_maximum) == false) {
    table.error("travel_minimum", "must be below the axis's own travel_maximum");
  }
  if (below(own.travel_minimum, theirs.travel_maximum) == false) {
    table.error("travel_maximum", "must be above the axis's own travel_minimum");
  }
  if (table.has("require_homing") && !theirs.require_homing) {
    table.error("require_homing", "can only be true here, since limits for some are never wider; leave it out");
  }
}

std::string wrong_with_whose(std::string_view whose) {
  if (whose == "observer" || whose == "nobody") return "moves nothing anyway";
  return wrong_with_caller(whose, "is neither a role nor a caller as the daemon names them");
}

std::string read_whose(ConfigTable& table) {
  constexpr std::string_view kAllowed =
      "a role, \"operator\" or \"admin\", or a caller, \"unix LOGIN\", \"cert NAME\" or \"token NAME\"";
  const std::optional<std::string> whose = table.text("whose");
  if (!whose && !table.has("whose")) table.missing("whose", kAllowed);
  if (!whose || *whose == "operator" || *whose == "admin") return whose.value_or("");
  if (const std::string wrong = wrong_with_whose(*whose); !wrong.empty()) {
    table.error("whose", fmt::format("\"{}\" {}; use {}", *whose, wrong, kAllowed));
  }
  return *whose;
}

AxisProfile read_axis(ConfigTable& table, std::string_view file, std::vector<ConfigError>& errors) {
  AxisProfile axis;
  axis.name = table.text("name").value_or("");
  if (!axis.name.empty() && !is_name(axis.name)) {
    table.error("name", fmt::format("\"{}\" is not a name; use {}", axis.name, kNameRule));
  }
  const std::optional<Stage> stage = read_stage(table, file, errors);
  if (stage) {
    axis.unit = unit_on(table, *stage);
  } else {
    // If the stage profile cannot be read, the axis's own amounts are not wrong.
    axis.unit = read_unit(table, "unit").value_or(table.has("stage") ? Unit::pulses : axis.unit);
  }
  read_limits(table, axis.unit, axis);
  if (stage) put_on_stage(table, *stage, axis);
  return axis;
}

LimitOverride read_override(ConfigTable& table, const AxisProfile& axis) {
  LimitOverride theirs;
  theirs.whose = read_whose(table);
  read_limits(table, axis.unit, theirs);
  if (axis.stage) check_whole_pulses(table, *axis.stage, theirs);
  if (std::ranges::none_of(kLimitKeys, [&](std::string_view key) { return table.has(key); })) {
    table.error("whose", fmt::format("is limited in nothing; give some of {}", fmt::join(kLimitKeys, ", ")));
  }
  check_override(table, axis, theirs);
  const bool twice = std::ranges::find(axis.overrides, theirs.whose, &LimitOverride::whose) != axis.overrides.end();
  if (twice && !theirs.whose.empty()) {
    table.error("whose", fmt::format("\"{}\" has an override of this axis already; put them together", theirs.whose));
  }
  table.refuse_unknown();
  return theirs;
}

}  // namespace

void read_axes(ConfigTable& device, std::string_view file, std::vector<ConfigError>& errors, int count,
               std::array<AxisProfile, stage::kAxesMax>& axes) {
  std::set<std::int64_t> numbers;
  std::set<std::string> names;
  for (const toml::table* source : device.tables("axis")) {
    ConfigTable table(*source, "device.axis", file, errors);
    const std::optional<std::int64_t> number = table.integer("number", 1, count);
    if (!number && !table.has("number")) table.missing("number", fmt::format("1 to {}", count));
    if (number && !numbers.insert(*number).second) {
      table.error("number", fmt::format("{} is the number of another axis of this device, too", *number));
    }
    AxisProfile axis = read_axis(table, file, errors);
    if (!axis.name.empty() && !names.insert(axis.name).second) {
      table.error("name", fmt::format("\"{}\" is the name of another axis of this device, too", axis.name));
    }
    for (const toml::table* theirs : table.tables("override")) {
      ConfigTable whose(*theirs, "device.axis.override", file, errors);
      axis.overrides.push_back(read_override(whose, axis));
    }
    if (number) axes[static_cast<std::size_t>(*number - 1)] = std::move(axis);
    table.refuse_unknown();
  }
}

}  // namespace axisgate::server
