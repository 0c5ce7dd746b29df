// The addresses of the configuration, and its table [network].
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/config/config.h"

namespace axisgate::server {

// Reads a loopback address. The error about any other address says how to serve other machines. `what` is the service
// at this address, such as "gRPC".
void read_loopback(ConfigTable& table, std::string_view key, std::string_view what, TcpAddress& address);

// Reads the table and checks the files that it names. nullopt without the table.
std::optional<NetworkConfig> read_network(ConfigTable& root, std::string_view file, std::vector<ConfigError>& errors);

}  // namespace axisgate::server
