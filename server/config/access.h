// The table [access] of the configuration.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/access/access.h"
#include "server/config/config.h"

namespace axisgate::server {

// All that the configuration may keep for administrators: the commands of each kind of device, and taking axes over.
std::vector<AdminCommand> admin_commands(DeviceKinds kinds);

// `access` comes with the defaults.
void read_access(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                 AccessConfig& access);

}  // namespace axisgate::server
