// The keys in the table of a mill that other devices do not have.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/config/config.h"
#include "server/config/connection.h"

namespace axisgate::server {

// Reads all keys except the kind, and sets `device`'s connection. Without the key, the baud is that of the mill's
// profile. Errors in the profile name the profile's own file and line.
MillConfig read_mill(ConfigTable& table, const jobs::Kind& kind, std::string_view file,
                     std::vector<ConfigError>& errors, ConnectionReader& connections, DeviceConfig& device);

}  // namespace axisgate::server
