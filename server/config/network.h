// The addresses of the configuration, and its table [network].
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/config/config.h"

namespace axisgate::server {

// A loopback address; any other is refused, with how to serve other machines. `what` is offered there: "gRPC".
void read_loopback(ConfigTable& table, std::string_view key, std::string_view what, TcpAddress& address);

// Nothing without that table. The files that it names are read and checked, too.
std::optional<NetworkConfig> read_network(ConfigTable& root, std::string_view file, std::vector<ConfigError>& errors);

}  // namespace axisgate::server
