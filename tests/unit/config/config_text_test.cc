#include <gmock/gmock.h>

#include <string>

#include "server/config/text.h"
#include "server/kinds.h"

namespace axisgate::server::config_text_test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kLab = R"(
socket = "/run/lab/\"gate\"\\\u0007.sock"

[access]
local = "observer"
admin_commands = ["BEC:", "take-over"]
roles = { "unix alice" = "admin" }

[[device]]
name = "stage"
connection = "serial"
path = "/dev/ttyUSB0"
parity = "even"
stop_bits = 2
flow_control = "none"
serial_number = "2106001001"
busy_scope = "axis"
at_exit = "finish"
reply_limit_ms = 750
record = "/var/tmp/stage.recording"
record_megabytes = 64

[[device.axis]]
number = 2
name = "y"
unit = "deg"
travel_minimum = "-5.25deg"
maximum_speed = "2deg/s"

[[device]]
name = "far"
connection = "tcp"
host = "moxa.lab"
port = 4001

[[device]]
name = "toy"
connection = "simulated"
baud = 9600
speed = 0.5
options = { busy_scope = "controller" }
)";

TEST(ConfigText, IsReadAsTheSameConfiguration) {
  const Configured<Config> config = parse_config(kLab, "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const std::string text = to_toml(*config);
  const Configured<Config> again = parse_config(text, "again.toml", device_kinds());
  ASSERT_TRUE(again) << to_string(again.error().front()) << text;
  EXPECT_EQ(to_toml(*again), text);
  EXPECT_EQ(again->socket, config->socket);
  EXPECT_EQ(again->devices.at(0).record, "/var/tmp/stage.recording");
  for (const char* line : {"listen = \"127.0.0.1:50203\"",
                           "local = \"observer\"",
                           "admin_commands = [\"BEC:\", \"take-over\"]",
                           "roles = { \"unix alice\" = \"admin\" }",
                           "path = \"/dev/ttyUSB0\"",
                           "baud = 38400",
                           "parity = \"even\"",
                           "stop_bits = 2",
                           "flow_control = \"none\"",
                           "serial_number = \"2106001001\"",
                           "busy_scope = \"axis\"",
                           "prebuffer_scope = \"controller\"",
                           "at_exit = \"finish\"",
                           "wait_for_inputs = false",
                           "settings_at_lease_end = \"restored\"",
                           "reply_limit_ms = 750",
                           "idle_poll_ms = 1000",
                           "name = \"y\"\nunit = \"deg\"\ntravel_minimum = \"-5.25deg\"\nmaximum_speed = \"2deg/s\"",
                           "host = \"moxa.lab\"\nport = 4001\nbaud = 38400",
                           "speed = 0.5\nbaud = 9600",
                           "options = { \"busy_scope\" = \"controller\" }"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
}

TEST(ConfigText, TheTravelEnvelopeIsReadAsTheSame) {
  const std::string axis = R"([[device.axis]]
number = 2
unit = "deg"
travel_minimum = "-5.25deg"
maximum_speed = "2deg/s"
require_homing = true

[[device.axis.override]]
whose = "operator"
travel_maximum = "3.5deg"

[[device.axis.override]]
whose = "cert \"Ann\" Lee"
maximum_speed = "500pulse/s"
require_homing = true
)";
  const auto config =
      parse_config("[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n" + axis, "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const std::string text = to_toml(*config);
  EXPECT_THAT(text, HasSubstr(axis));
  const Configured<Config> again = parse_config(text, "again.toml", device_kinds());
  ASSERT_TRUE(again) << to_string(again.error().front()) << text;
  EXPECT_EQ(to_toml(*again), text);
}

TEST(ConfigText, AStageIsReadAsTheSame) {
  const std::string axis = R"([[device.axis]]
number = 3
unit = "pulse"
travel_minimum = "-2.5deg"
maximum_speed = "30deg/s"

[device.axis.stage]
name = "OSMS-60YAW"
kind = "rotary"
pulse = "0.0025deg"
modulo = "360deg"

[[device.axis.override]]
whose = "operator"
travel_maximum = "90deg"
)";
  const auto config =
      parse_config("[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n" + axis, "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const std::string text = to_toml(*config);
  EXPECT_THAT(text, HasSubstr(axis));
  const Configured<Config> again = parse_config(text, "again.toml", device_kinds());
  ASSERT_TRUE(again) << to_string(again.error().front()) << text;
  EXPECT_EQ(to_toml(*again), text);
  EXPECT_EQ(std::get<StageConfig>(again->devices.at(0).family).profile.axes[2].stage->pulse, (Scale{{2500, 0}, true}));
}

TEST(ConfigText, AMillIsReadAsTheSame) {
  const std::string own = R"(streaming = "full"
window = 128
buffer = 2048
converter = 0
slack = "measured"
station = ["unix alice", "token anna"]
confirmation_minutes = 5
tools = ["T1", "ball-nose_3"]
busy_limit_s = 60
at_loss = "leave"
at_exit = "finish"

[[device.origin]]
name = "vice"
x = 400
y = 0
z = -800

[[device.origin]]
name = "corner"
x = 0
y = 6096
)";
  const std::string simulated = R"(kind = "rml1"
connection = "simulated"
speed = 0.5
baud = 19200
options = { "cover_open" = "ends" }
slower = 0.1
profile = "MDX-540"
)";
  const auto config = parse_config(
      "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"serial\"\n"
      "path = \"/dev/ttyS0\"\n" +
          own + "[[device]]\nname = \"toy\"\n" + simulated +
          "[[device]]\nname = \"far\"\nkind = \"rml1\"\nprofile = \"srm-20\"\nconnection = \"tcp\"\nhost = "
          "\"moxa\"\nport = 1\n",
      "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const std::string text = to_toml(*config);
  const Configured<Config> again = parse_config(text, "again.toml", device_kinds());
  ASSERT_TRUE(again) << to_string(again.error().front()) << text;
  EXPECT_EQ(to_toml(*again), text);
  EXPECT_THAT(text, HasSubstr("flow_control = \"rtscts\"\nprofile = \"mdx-20\"\n" + own));
  EXPECT_THAT(text, HasSubstr("name = \"toy\"\n" + simulated));
  EXPECT_THAT(text, HasSubstr(R"(name = "far"
kind = "rml1"
connection = "tcp"
host = "moxa"
port = 1
baud = 9600
profile = "srm-20"
streaming = "paced"
buffer = 1024
converter = 512
slack = 1.5
station = ["unix"]
confirmation_minutes = 10
tools = ["T1"]
busy_limit_s = 600
at_loss = "abort"
at_exit = "abort"
)"));
}

TEST(ConfigText, TellsTheBuiltInConfiguration) {
  const Configured<Config> again = parse_config(to_toml(default_config(device_kinds())), "again.toml", device_kinds());
  ASSERT_TRUE(again) << to_string(again.error().front());
  EXPECT_EQ(again->devices.at(0).name, "stage");
}

}  // namespace
}  // namespace axisgate::server::config_text_test
