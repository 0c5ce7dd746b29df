// The tables [[device.axis]] of the configuration: names, units, and the travel envelope.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "device/stage/profile.h"
#include "server/config/config.h"

namespace axisgate::server {

// Reads the axes of the table `device`, numbered from 1 to `count`. An axis without a table stays unchanged.
void read_axes(ConfigTable& device, std::string_view file, std::vector<ConfigError>& errors, int count,
               std::array<stage::AxisProfile, stage::kAxesMax>& axes);

}  // namespace axisgate::server
