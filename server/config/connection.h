// The keys with which the table of a device, of any family, describes its connection.
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

// One ConnectionReader reads all devices of a file, since no two may share a line.
class ConnectionReader {
 public:
  // Checks an option of the simulator; the error names the allowed values.
  using CheckOption = std::function<Result<void>(std::string_view name, std::string_view value)>;

  // The referenced objects must outlive this one.
  ConnectionReader(std::string_view file, std::vector<ConfigError>& errors) : file_(file), errors_(errors) {}

  // Sets the device's connection and baud. Without the key, the baud is `usual_baud`, or that of USB for a printer.
  // Reports an error and returns nullopt if the kind of connection is missing or wrong.
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
