// The example configurations of two mills, and the warnings about a mill's line that are not errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "server/config/config.h"
#include "server/kinds.h"
#include "tests/paths/paths.h"

namespace axisgate::server::config_mill_doubts_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kSerial =
    "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"serial\"\n"
    "path = \"/dev/ttyUSB0\"\n";
constexpr const char* kSimulated =
    "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"simulated\"\n";

MillConfig mill_in(const Config& config) { return std::get<MillConfig>(config.devices.at(0).family); }

// The examples need no further key and cause no warning.
TEST(ConfigMills, ThoseOfTwoMillsAreReadyToUse) {
  for (const char* name : {"srm-20", "mdx-20"}) {
    const auto config = load_config(paths::in_project("deploy/" + std::string(name) + ".toml"), device_kinds());
    ASSERT_TRUE(config) << to_string(config.error().front());
    EXPECT_EQ(mill_in(*config).profile_name, name);
    EXPECT_THAT(mill_in(*config).doubts, IsEmpty()) << name;
    EXPECT_EQ(mill_in(*config).sending.streaming, jobs::Streaming::full) << name;
  }
}

// The doubts are not errors: some mills are connected like this.
TEST(ConfigMills, DoubtsAreNamed) {
  const auto doubts = [](std::string text, std::string_view profile) {
    text.replace(text.find("mdx-20"), 6, profile);
    return mill_in(*parse_config(text, "lab.toml", device_kinds())).doubts;
  };
  EXPECT_THAT(
      doubts(kSerial, "srm-20"),
      ElementsAre(HasSubstr("no baud rate is given, and 9600 baud are assumed: the SRM-20 is usually connected by USB"),
                  HasSubstr("`flow_control` is not given: RTS/CTS is assumed")));
  EXPECT_THAT(doubts(kSerial, "mdx-20"), ElementsAre(HasSubstr("`flow_control` is not given")));
  EXPECT_THAT(doubts(std::string(kSerial) + "flow_control = \"none\"\n", "mdx-20"),
              ElementsAre(HasSubstr("no flow control: a full buffer of the mill loses bytes")));
  const std::string said = std::string(kSerial) + "baud = 9600\nflow_control = \"xonxoff\"\n";
  EXPECT_THAT(doubts(said, "srm-20"), IsEmpty());
  EXPECT_THAT(mill_in(*parse_config(kSimulated, "lab.toml", device_kinds())).doubts, IsEmpty());
}

}  // namespace
}  // namespace axisgate::server::config_mill_doubts_test
