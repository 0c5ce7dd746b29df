// The table [jobs] of the configuration.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/config/config.h"

namespace axisgate::server {

void read_jobs(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors, JobsConfig& jobs);

}  // namespace axisgate::server
