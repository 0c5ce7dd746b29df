// The table [access] of the configuration.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/access/access.h"
#include "server/config/config.h"

namespace axisgate::server {

// Returns the values that `admin_commands` may have: the commands of each kind of device, and "take-over".
std::vector<AdminCommand> admin_commands(DeviceKinds kinds);

// `access` initially contains the defaults.
void read_access(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                 AccessConfig& access);

}  // namespace axisgate::server
