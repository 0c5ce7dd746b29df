// A configuration as text: the other way round than config.h.
#pragma once

#include <string>

#include "server/config/config.h"

namespace axisgate::server {

// TOML with every key that is in effect, defaults included; parse_config() reads it as the same configuration.
std::string to_toml(const Config& config);

}  // namespace axisgate::server
