// The table [journal] of the configuration.
#pragma once

#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/config/config.h"

namespace axisgate::server {

void read_journal(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                  JournalConfig& journal);

}  // namespace axisgate::server
