// How a device is reached: the keys of its table that every family has for that.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "device/config/config_table.h"
#include "server/config/config.h"

namespace axisgate::server {

enum class ConnectionKind { serial, tcp, simulated, printer };

// Of all devices of a file, since no two share a line.
class ConnectionReader {
 public:
  // An option of the simulator; what is wrong with it names what may be chosen.
  using CheckOption = std::function<Result<void>(std::string_view name, std::string_view value)>;

  // What is referred to outlives this.
  ConnectionReader(std::string_view file, std::vector<ConfigError>& errors) : file_(file), errors_(errors) {}

  // Sets the device's connection, and its baud, which is `usual_baud` without the key, or that of USB for a printer.
  // Nothing where it is not known how the device is connected, which is an error then.
  std::optional<ConnectionKind> read(ConfigTable& table, int usual_baud, const CheckOption& check_option,
                                     DeviceConfig& device);

 private:
  std::string read_path(ConfigTable& table, std::string_view what, std::string_view example);
  SerialSettings read_serial(ConfigTable& table, int baud);
  TcpSettings read_tcp(ConfigTable& table);
  SimulatedConnection read_simulated(ConfigTable& table, const CheckOption& check_option);

  std::string_view file_;
  std::vector<ConfigError>& errors_;
  std::set<std::string> lines_;
};

}  // namespace axisgate::server
