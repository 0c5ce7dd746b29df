// Stage profiles: what a stage is and may do, in a small TOML file of its own that axes name (deploy/stages).
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
  Unit unit = Unit::micrometers;  // how positions are shown, unless the axis says otherwise
  stage::AxisLimits limits;       // its travel and its speed
};

// The profile that the key `stage` of an axis's table names: a path, of which a relative one counts from the folder of
// `file`, or the profile itself as a table. Nothing where there is no such key, or where something is wrong, which is
// an error at the profile's own file and line.
std::optional<Stage> read_stage(ConfigTable& axis, std::string_view file, std::vector<ConfigError>& errors);

// Another unit than the stage's, where the axis has one that fits.
Unit unit_on(ConfigTable& axis, const Stage& stage);

// Gives the axis, whose own limits have been read, its stage and the limits of that. The axis's own can only be
// narrower: errors otherwise.
void put_on_stage(ConfigTable& table, const Stage& stage, stage::AxisProfile& axis);

// Errors at the amounts of the table that are no whole pulses of the stage.
void check_whole_pulses(ConfigTable& table, const stage::StageProfile& stage, const stage::AxisLimits& limits);

}  // namespace axisgate::server
