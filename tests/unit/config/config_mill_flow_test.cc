// Flow control of a mill's lines: which of them keep the host from sending more than the mill has room for.
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "server/config/config.h"
#include "server/kinds.h"

namespace axisgate::server::config_mill_flow_test {
namespace {

bool holds_back(const std::string& connection) {
  const std::string mill = "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\n";
  const auto config = parse_config(mill + connection, "lab.toml", device_kinds());
  EXPECT_TRUE(config) << to_string(config.error().front());
  return config && std::get<MillConfig>(config->devices.at(0).family).sending.flow_control;
}

TEST(ConfigMillFlow, IsThatOfASerialPort) {
  const std::string serial = "connection = \"serial\"\npath = \"/dev/ttyUSB0\"\n";
  EXPECT_TRUE(holds_back(serial)) << "RTS/CTS";
  EXPECT_TRUE(holds_back(serial + "flow_control = \"xonxoff\"\n"));
  EXPECT_FALSE(holds_back(serial + "flow_control = \"none\"\n"));
}

TEST(ConfigMillFlow, IsThatOfAPrinterDeviceAndOfNoOtherLine) {
  EXPECT_TRUE(holds_back("connection = \"printer\"\npath = \"/dev/usb/lp0\"\n"));
  EXPECT_FALSE(holds_back("connection = \"tcp\"\nhost = \"moxa.lab\"\nport = 4001\n"));
  EXPECT_FALSE(holds_back("connection = \"simulated\"\n"));
}

}  // namespace
}  // namespace axisgate::server::config_mill_flow_test
