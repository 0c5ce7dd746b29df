// The table [limits] of the configuration.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "server/config/config.h"
#include "server/config/text.h"
#include "server/kinds.h"

namespace axisgate::server::config_limits_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Configured<Config> read(const std::string& lines) {
  return parse_config("[limits]\n" + lines + "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n", "lab.toml",
                      device_kinds());
}

std::vector<std::string> errors_of_limits(const std::string& lines) {
  std::vector<std::string> errors;
  if (const auto config = read(lines); !config) {
    for (const ConfigError& error : config.error()) errors.push_back(to_string(error));
  }
  return errors;
}

TEST(ConfigLimits, AreGenerousUnlessSaidOtherwise) {
  const auto config = read("");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->limits.connections, 512);
  EXPECT_EQ(config->limits.streams, 2048);
  EXPECT_EQ(config->limits.calls, 1024);
  EXPECT_EQ(config->limits.message_bytes, 4'194'304);
}

TEST(ConfigLimits, AreReadAndWrittenWhole) {
  const std::string lines = "connections = 16\nstreams = 32\ncalls = 64\nmessage_bytes = 65536\n";
  const auto config = read(lines);
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->limits.connections, 16);
  EXPECT_EQ(config->limits.streams, 32);
  EXPECT_EQ(config->limits.calls, 64);
  EXPECT_EQ(config->limits.message_bytes, 65536);
  EXPECT_THAT(to_toml(*config), HasSubstr("[limits]\n" + lines));
}

TEST(ConfigLimits, AreCheckedWithLineAndKey) {
  EXPECT_THAT(
      errors_of_limits("connections = 0\nstreams = 4097\ncalls = \"many\"\nmessage_bytes = 4095\n"),
      ElementsAre("lab.toml:2: limits.connections: 0 is out of range; use a whole number from 1 to 4096",
                  "lab.toml:3: limits.streams: 4097 is out of range; use a whole number from 1 to 4096",
                  "lab.toml:4: limits.calls: the text \"many\" will not do; use a whole number from 1 to 65536",
                  "lab.toml:5: limits.message_bytes: 4095 is out of range; use a whole number from 4096 to 67108864"));
  EXPECT_THAT(
      errors_of_limits("requests = 5\n"),
      ElementsAre(StartsWith("lab.toml:2: limits.requests: is not a key here; use connections, streams, calls")));
}

}  // namespace
}  // namespace axisgate::server::config_limits_test
