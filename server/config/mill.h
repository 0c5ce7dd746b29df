// The table of a mill, beyond what every device has.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/config/config.h"
#include "server/config/connection.h"

namespace axisgate::server {

// Without its kind. `device` gets its connection; without the key, its baud is that of the mill's profile. Errors in
// the profile have the profile's own file and line.
MillConfig read_mill(ConfigTable& table, std::string_view file, std::vector<ConfigError>& errors,
                     ConnectionReader& connections, DeviceConfig& device);

}  // namespace axisgate::server
