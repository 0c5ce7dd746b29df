// Conversion of a configuration to text.
#pragma once

#include <string>

#include "server/config/config.h"

namespace axisgate::server {

// Returns TOML with every key in effect, including defaults. parse_config() reads it as the same configuration.
std::string to_toml(const Config& config);

}  // namespace axisgate::server
