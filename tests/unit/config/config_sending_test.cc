// Keys of a mill's table for sending jobs: streaming and slack.
#include <gmock/gmock.h>

#include <string>
#include <variant>
#include <vector>

#include "server/config/config.h"
#include "server/kinds.h"

namespace axisgate::server::config_sending_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Added lines begin in line 7 of kSerial and in line 6 of kSimulated.
const std::string kSerial =
    "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"serial\"\n"
    "path = \"/dev/ttyUSB0\"\n";
const std::string kSimulated =
    "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"simulated\"\n";

Configured<Config> parse(const std::string& text) { return parse_config(text, "lab.toml", device_kinds()); }

std::vector<std::string> errors_of(const std::string& text) {
  std::vector<std::string> lines;
  if (const auto config = parse(text); !config) {
    for (const ConfigError& error : config.error()) lines.push_back(to_string(error));
  }
  return lines;
}

std::vector<std::string> errors_with(const std::string& keys) { return errors_of(kSerial + keys); }

MillConfig mill_of(const Config& config) { return std::get<MillConfig>(config.devices.at(0).family); }

TEST(ConfigSending, FullStreamingNeedsALineThatHoldsTheHostBack) {
  EXPECT_THAT(errors_with("flow_control = \"none\"\nstreaming = \"full\"\n"),
              ElementsAre("lab.toml:8: device.streaming: \"full\" sends as fast as the line takes it, and with "
                          "flow_control = \"none\" nothing holds the host back, so bytes would be lost when the mill's "
                          "buffer is full; use \"paced\", or flow_control = \"rtscts\""));
  EXPECT_THAT(errors_with("flow_control = \"none\"\n"), IsEmpty());
  EXPECT_THAT(errors_with("streaming = \"full\"\n"), IsEmpty());
  EXPECT_THAT(
      errors_of(kSimulated + "streaming = \"full\"\n"),
      ElementsAre("lab.toml:6: device.streaming: \"full\" sends as fast as the line takes it, and nothing holds "
                  "the host back from the built-in simulator, so bytes would be lost when the mill's buffer is "
                  "full; use \"paced\", or rml1-sim on a port"));
}

TEST(ConfigSending, TheSlackIsANumberOrMeasured) {
  const auto config = parse(kSerial + "slack = 1.2\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(mill_of(*config).sending.slack, 1.2);
  EXPECT_FALSE(mill_of(*config).sending.slack_as_measured);
  EXPECT_THAT(errors_with("slack = 1\n"), IsEmpty());
  EXPECT_THAT(errors_with("slack = 0.9\n"),
              ElementsAre("lab.toml:7: device.slack: the number 0.900000 will not do; use a number from 1 to 10, or "
                          "\"measured\""));
  EXPECT_THAT(errors_with("slack = \"fast\"\n"),
              ElementsAre("lab.toml:7: device.slack: \"fast\" is not known; use a number from 1 to 10, or "
                          "\"measured\""));
}

}  // namespace
}  // namespace axisgate::server::config_sending_test
