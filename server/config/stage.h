// Stage profiles: properties and limits of a stage, in a small TOML file that axes name (deploy/stages).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "device/stage/profile.h"
#include "server/config/config.h"

namespace axisgate::server {

struct Stage {
  stage::StageProfile profile;
  Unit unit = Unit::micrometers;  // unit of positions, unless the axis has another
  stage::AxisLimits limits;       // travel and speed
};

// Returns the profile that the key `stage` of an axis's table names: a path, relative to the folder of `file`, or the
// profile itself as a table. nullopt if the key is absent, or if the profile has an error, which is reported at its own
// file and line.
std::optional<Stage> read_stage(ConfigTable& axis, std::string_view file, std::vector<ConfigError>& errors);

// Returns the axis's own unit if it has one that fits, otherwise the stage's.
Unit unit_on(ConfigTable& axis, const Stage& stage);

// Gives the axis, whose own limits have been read, its stage and the stage's limits. Reports an error if a limit of the
// axis is beyond the stage's.
void put_on_stage(ConfigTable& table, const Stage& stage, stage::AxisProfile& axis);

// Reports an error for each amount of the table that is not a whole number of the stage's pulses.
void check_whole_pulses(ConfigTable& table, const stage::StageProfile& stage, const stage::AxisLimits& limits);

}  // namespace axisgate::server
