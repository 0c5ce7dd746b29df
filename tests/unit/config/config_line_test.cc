// The lines of mills in the configuration: printer devices, and flow control by XON/XOFF or DTR/DSR.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "server/config/text.h"
#include "server/kinds.h"
#include "server/recording/redaction.h"

namespace axisgate::server::config_line_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kMill = "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\n";
constexpr const char* kPrinter = "connection = \"printer\"\npath = \"/dev/usb/lp0\"\n";

Configured<Config> parse(const std::string& text) { return parse_config(text, "lab.toml", device_kinds()); }

std::vector<std::string> errors_of(const std::string& text) {
  std::vector<std::string> lines;
  if (const auto config = parse(text); !config) {
    for (const ConfigError& error : config.error()) lines.push_back(to_string(error));
  }
  return lines;
}

TEST(ConfigLine, AMillMayBeAPrinter) {
  const auto config = parse(std::string(kMill) + kPrinter + "streaming = \"full\"\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(std::get<PrinterSettings>(config->devices.at(0).connection).path, "/dev/usb/lp0");
  EXPECT_EQ(config->devices.at(0).baud, 1'000'000) << "not that of the profile";
  const std::string text = to_toml(*config);
  EXPECT_THAT(text, HasSubstr("connection = \"printer\"\npath = \"/dev/usb/lp0\"\nprofile"));
  EXPECT_TRUE(parse(text)) << "what is written can be read";
}

TEST(ConfigLine, ThePathOfAPrinterIsHidden) {
  const auto config = parse(std::string(kMill) + "connection = \"printer\"\npath = \"/srv/anna/mill\"\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_THAT(to_toml(Redactor().redact(*config)), Not(HasSubstr("anna")));
}

TEST(ConfigLine, APrinterHasAPathOfItsOwnAndNoRate) {
  EXPECT_THAT(errors_of(std::string(kMill) + "connection = \"printer\"\n"),
              ElementsAre("lab.toml:1: device.path: is missing; use the printer device, e.g. \"/dev/usb/lp0\""));
  EXPECT_THAT(errors_of(std::string(kMill) + kPrinter + "baud = 9600\n"),
              ElementsAre(StartsWith("lab.toml:7: device.baud: is not a key here; ")));
  EXPECT_THAT(errors_of(std::string(kMill) + kPrinter +
                        "[[device]]\nname = \"other\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\n" + kPrinter),
              ElementsAre(HasSubstr("\"/dev/usb/lp0\" is the line of another device, too; each has its own")));
}

TEST(ConfigLine, NoStageIsAPrinter) {
  EXPECT_THAT(errors_of(std::string("[[device]]\nname = \"stage\"\n") + kPrinter),
              ElementsAre("lab.toml:3: device.connection: \"printer\" is for mills: a printer device never answers; "
                          "use \"serial\""));
}

TEST(ConfigLine, FlowControlByCharacters) {
  const auto config = parse(std::string(kMill) +
                            "connection = \"serial\"\npath = \"/dev/ttyUSB0\"\nflow_control = \"xonxoff\"\n"
                            "streaming = \"full\"\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(std::get<SerialSettings>(config->devices.at(0).connection).flow, FlowControl::xon_xoff);
  EXPECT_THAT(to_toml(*config), HasSubstr("flow_control = \"xonxoff\"\n"));
}

TEST(ConfigLine, FlowControlByDtrAndDsrIsForMills) {
  const std::string serial = "connection = \"serial\"\npath = \"/dev/ttyUSB0\"\nflow_control = \"dtr_dsr\"\n";
  const auto config = parse(kMill + serial + "streaming = \"full\"\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(std::get<SerialSettings>(config->devices.at(0).connection).flow, FlowControl::dtr_dsr);
  EXPECT_THAT(to_toml(*config), HasSubstr("flow_control = \"dtr_dsr\"\n"));
  EXPECT_THAT(errors_of("[[device]]\nname = \"stage\"\n" + serial),
              ElementsAre("lab.toml:5: device.flow_control: \"dtr_dsr\" is for mills: no driver does it, and a command "
                          "to a stage does not wait for it; use \"rtscts\""));
}

}  // namespace
}  // namespace axisgate::server::config_line_test
