// The table [access] of the configuration.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/access/access.h"
#include "server/config/config.h"

namespace axisgate::server {

void read_access(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                 AccessConfig& access);

}  // namespace axisgate::server
