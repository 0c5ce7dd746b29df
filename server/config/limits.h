// The table [limits] of the configuration.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/access/identity_limits.h"
#include "server/config/config.h"

namespace axisgate::server {

void read_identity_limits(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                          LimitsConfig& limits);

}  // namespace axisgate::server
