#include "server/config/config.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "device/config/config_file.h"
#include "server/kinds.h"
#include "tests/paths/paths.h"

namespace axisgate::server::config_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kStage = "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n";

std::vector<std::string> errors_of(const std::string& text) {
  const Configured<Config> config = parse_config(text, "lab.toml", device_kinds());
  std::vector<std::string> lines;
  if (!config) {
    for (const ConfigError& error : config.error()) lines.push_back(to_string(error));
  }
  return lines;
}

TEST(Config, DefaultIsOneSimulatedStageOnLoopback) {
  const Config config = default_config(device_kinds());
  EXPECT_EQ(to_string(config.listen), "127.0.0.1:50203");
  EXPECT_EQ(to_string(config.metrics), "127.0.0.1:9203");
  ASSERT_EQ(config.devices.size(), 1u);
  EXPECT_EQ(config.devices[0].name, "stage");
  EXPECT_TRUE(std::holds_alternative<SimulatedConnection>(config.devices[0].connection));
}

TEST(Config, ReadsASerialDeviceWhole) {
  const auto config = parse_config(R"(
listen = "[::1]:5000"
socket = "/run/lab/gate.sock"
metrics = "localhost:0"

[[device]]
name = "stage"
kind = "shrc203"
connection = "serial"
path = "/dev/ttyUSB0"
baud = 9600
parity = "even"
stop_bits = 2
flow_control = "none"
serial_number = "2106001001"
busy_scope = "axis"
prebuffer_scope = "axis"
at_exit = "finish"
settings_at_lease_end = "kept"
reply_limit_ms = 750
idle_poll_ms = 2000
moving_poll_ms = 50

[[device.axis]]
number = 2
name = "y"
unit = "mm"
travel_minimum = "-5mm"
travel_maximum = "2500um"
maximum_speed = "2mm/s"
)",
                                   "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(to_string(config->listen), "[::1]:5000");
  EXPECT_EQ(config->socket, "/run/lab/gate.sock");
  EXPECT_EQ(to_string(config->metrics), "127.0.0.1:0");
  const auto& stage = std::get<StageConfig>(config->devices.at(0).family);
  const stage::Profile& profile = stage.profile;
  const Words& kind_settings = stage.kind_settings;
  EXPECT_EQ(profile.serial_number, "2106001001");
  EXPECT_EQ(kind_settings.at("busy_scope"), "axis");
  EXPECT_EQ(kind_settings.at("prebuffer_scope"), "axis");
  EXPECT_EQ(profile.at_exit, stage::AtExit::finish);
  EXPECT_EQ(profile.settings_at_lease_end, stage::AtLeaseEnd::kept);
  EXPECT_EQ(config->devices.at(0).baud, 9600);
  EXPECT_EQ(profile.reply_limit, std::chrono::milliseconds(750));
  EXPECT_EQ(profile.idle_poll, std::chrono::seconds(2));
  EXPECT_EQ(profile.moving_poll, std::chrono::milliseconds(50));
  const stage::AxisProfile& axis = profile.axes[1];
  EXPECT_EQ(axis.name, "y");
  EXPECT_EQ(axis.unit, Unit::millimeters);
  ASSERT_TRUE(axis.travel_minimum && axis.travel_maximum && axis.maximum_speed);
  EXPECT_EQ(axis.travel_minimum->value, (Decimal{-5, 0}));
  EXPECT_EQ(axis.travel_maximum->unit, Unit::micrometers);
  EXPECT_EQ(axis.maximum_speed->value, (Decimal{2, 0}));
  const auto& serial = std::get<SerialSettings>(config->devices[0].connection);
  EXPECT_EQ(serial.path, "/dev/ttyUSB0");
  EXPECT_EQ(serial.baud, 9600);
  EXPECT_EQ(serial.parity, Parity::even);
  EXPECT_EQ(serial.stop_bits, 2);
  EXPECT_EQ(serial.flow, FlowControl::none);
}

TEST(Config, SerialDefaultsAre38400WithRtsCts) {
  const auto config = parse_config("[[device]]\nname = \"s\"\nconnection = \"serial\"\npath = \"/dev/ttyS0\"\n",
                                   "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const auto& serial = std::get<SerialSettings>(config->devices.at(0).connection);
  EXPECT_EQ(serial.baud, 38400);
  EXPECT_EQ(serial.parity, Parity::none);
  EXPECT_EQ(serial.stop_bits, 1);
  EXPECT_EQ(serial.flow, FlowControl::rts_cts);
}

TEST(Config, ReadsASerialServersPort) {
  const auto config = parse_config(R"([[device]]
name = "s"
connection = "tcp"
host = "moxa.lab"
port = 4001
baud = 9600
serial_number = "7"
)",
                                   "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const DeviceConfig& device = config->devices.at(0);
  EXPECT_EQ(to_string(std::get<TcpSettings>(device.connection)), "moxa.lab:4001");
  EXPECT_EQ(device.baud, 9600);
  EXPECT_EQ(std::get<StageConfig>(device.family).profile.serial_number, "7");
}

TEST(Config, AnIpV6AddressIsAHost) {
  const auto config = parse_config("[[device]]\nname = \"s\"\nconnection = \"tcp\"\nhost = \"fe80::1\"\nport = 1\n",
                                   "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(std::get<TcpSettings>(config->devices.at(0).connection).host, "fe80::1");
}

TEST(Config, ASerialServersHostAndPortAreChecked) {
  const std::string tcp = "[[device]]\nname = \"s\"\nconnection = \"tcp\"\n";
  EXPECT_THAT(errors_of(tcp), ElementsAre(StartsWith("lab.toml:1: device.host: is missing; use "),
                                          StartsWith("lab.toml:1: device.port: is missing; use ")));
  EXPECT_THAT(errors_of(tcp + "host = \"moxa:4001\"\nport = 65536\n"),
              ElementsAre(StartsWith("lab.toml:4: device.host: \"moxa:4001\" is neither a host name nor an address"),
                          "lab.toml:5: device.port: 65536 is out of range; use a whole number from 1 to 65535"));
  EXPECT_THAT(errors_of(tcp + "host = \"moxa\"\nport = 4001\nparity = \"even\"\n"),
              ElementsAre(StartsWith("lab.toml:6: device.parity: is not a key here; use ")));
}

TEST(Config, TwoDevicesCannotShareASerialServersPort) {
  const std::string line = "connection = \"tcp\"\nhost = \"moxa\"\nport = 4001\n";
  EXPECT_THAT(errors_of("[[device]]\nname = \"a\"\n" + line + "[[device]]\nname = \"b\"\n" + line),
              ElementsAre("lab.toml:10: device.port: moxa:4001 is the line of another device, too; each has its own"));
}

TEST(Config, ReadsASimulatedDevice) {
  const auto config =
      parse_config(std::string(kStage) + "speed = 10\nbaud = 38400\noptions = { busy_scope = \"controller\" }\n", "l",
                   device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const auto& simulated = std::get<SimulatedConnection>(config->devices.at(0).connection);
  EXPECT_EQ(simulated.speed, 10);
  EXPECT_TRUE(simulated.paced);
  EXPECT_THAT(simulated.options, ElementsAre(std::pair<std::string, std::string>("busy_scope", "controller")));
}

TEST(Config, AnUnknownUnitNamesFileLineKeyAndWhatIsAllowed) {
  EXPECT_THAT(errors_of(std::string(kStage) + "[[device.axis]]\nnumber = 1\nunit = \"micron\"\n"),
              ElementsAre("lab.toml:6: device.axis.unit: \"micron\" is not a unit; use pulse, nm, um, mm or deg"));
}

TEST(Config, EveryErrorIsReportedInTheOrderOfTheLines) {
  EXPECT_THAT(
      errors_of("listen = \"127.0.0.1\"\n"
                "[[device]]\n"
                "name = \"stage\"\n"
                "connection = \"serial\"\n"
                "baud = \"fast\"\n"
                "stop_bits = 3\n"
                "parity = \"mark\"\n"
                "colour = \"red\"\n"),
      ElementsAre(StartsWith("lab.toml:1: listen: \"127.0.0.1\" is not HOST:PORT"),
                  StartsWith("lab.toml:2: device.path: is missing"),
                  "lab.toml:5: device.baud: the text \"fast\" will not do; use a whole number from 300 to 4000000",
                  "lab.toml:6: device.stop_bits: 3 is out of range; use a whole number from 1 to 2",
                  "lab.toml:7: device.parity: \"mark\" is not known; use one of \"none\", \"even\", \"odd\"",
                  StartsWith("lab.toml:8: device.colour: is not a key here; use name, kind, connection")));
}

TEST(Config, KeysOfTheOtherConnectionAreUnknown) {
  EXPECT_THAT(errors_of(std::string(kStage) + "path = \"/dev/ttyUSB0\"\n"),
              ElementsAre(StartsWith("lab.toml:4: device.path: is not a key here")));
}

TEST(Config, NamesAndNumbersAreUnique) {
  EXPECT_THAT(errors_of(std::string(kStage) + "[[device.axis]]\nnumber = 1\nname = \"x\"\n" +
                        "[[device.axis]]\nnumber = 1\nname = \"x\"\n" + kStage),
              ElementsAre(StartsWith("lab.toml:8: device.axis.number: 1 is the number of another axis"),
                          StartsWith("lab.toml:9: device.axis.name: \"x\" is the name of another axis"),
                          StartsWith("lab.toml:11: device.name: \"stage\" is the name of another device")));
}

TEST(Config, TwoDevicesCannotShareALine) {
  const std::string serial = "connection = \"serial\"\npath = \"/dev/ttyUSB0\"\n";
  EXPECT_THAT(errors_of("[[device]]\nname = \"a\"\n" + serial + "[[device]]\nname = \"b\"\n" + serial),
              ElementsAre(StartsWith("lab.toml:8: device.path: \"/dev/ttyUSB0\" is the line of another device")));
}

TEST(Config, RecordingsAreAbsolutePathsEachItsOwn) {
  const std::string recorded = std::string(kStage) + "record = \"/var/tmp/stage.recording\"\n";
  const auto config = parse_config(recorded, "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->devices.at(0).record, "/var/tmp/stage.recording");
  EXPECT_EQ(config->devices.at(0).record_megabytes, 1024);
  EXPECT_THAT(errors_of(recorded + "record_megabytes = 31\n"),
              ElementsAre(StartsWith("lab.toml:5: device.record_megabytes: ")));
  EXPECT_THAT(errors_of(recorded + "[[device]]\nname = \"b\"\nconnection = \"simulated\"\n"
                                   "record = \"/var/tmp/stage.recording.1\"\n"),
              ElementsAre(HasSubstr("is the file of another")));
  EXPECT_THAT(errors_of(std::string(kStage) + "record = \"stage.recording\"\n"),
              ElementsAre(StartsWith("lab.toml:4: device.record: \"stage.recording\" is not an absolute path")));
  EXPECT_THAT(errors_of(std::string(kStage) + "record = \"\"\n"), ElementsAre(HasSubstr("is not an absolute path")));
  EXPECT_THAT(
      errors_of(recorded + "[[device]]\nname = \"b\"\nconnection = \"simulated\"\n"
                           "record = \"/var/tmp/stage.recording\"\n"),
      ElementsAre(StartsWith("lab.toml:8: device.record: \"/var/tmp/stage.recording\" is the file of another")));
}

TEST(Config, AFileWithoutADeviceIsAnError) {
  EXPECT_THAT(errors_of("listen = \"127.0.0.1:1\"\n"),
              ElementsAre(HasSubstr("device: is missing; use at least one [[device]]")));
}

TEST(Config, NetworkAddressesAreRefusedWithTheReason) {
  EXPECT_THAT(
      errors_of("listen = \"0.0.0.0:50203\"\nmetrics = \"lab.example:9203\"\n" + std::string(kStage)),
      ElementsAre(AllOf(HasSubstr("would offer gRPC to the network"), HasSubstr("by the table [network], with TLS")),
                  AllOf(HasSubstr("would offer metrics to the network"), HasSubstr("through a tunnel"))));
}

TEST(Config, PortsAndSocketsAreChecked) {
  EXPECT_THAT(errors_of("listen = \"127.0.0.1:65536\"\nsocket = \"gate.sock\"\n" + std::string(kStage)),
              ElementsAre(HasSubstr("is not HOST:PORT"), HasSubstr("use an absolute path of at most 107 bytes")));
}

TEST(Config, LimitsOfAnAxisFitTogether) {
  const std::string axis = std::string(kStage) + "[[device.axis]]\nnumber = 1\n";
  EXPECT_THAT(errors_of(axis + "travel_minimum = \"1mm\"\ntravel_maximum = \"900um\"\n"),
              ElementsAre("lab.toml:6: device.axis.travel_minimum: must be below travel_maximum"));
  EXPECT_THAT(errors_of(axis + "travel_maximum = \"90deg\"\n"),
              ElementsAre(HasSubstr("an axis turns or slides, not both")));
  EXPECT_THAT(errors_of(axis + "maximum_speed = \"0mm/s\"\n"), ElementsAre(HasSubstr("must be above 0")));
  EXPECT_THAT(errors_of(axis + "travel_maximum = \"far\"\n"),
              ElementsAre(StartsWith("lab.toml:6: device.axis.travel_maximum: ")));
  EXPECT_THAT(errors_of(axis + "travel_minimum = \"-5\"\nunit = \"mm\"\ntravel_maximum = \"5000um\"\n"), ElementsAre());
}

TEST(Config, SimulatorOptionsAreCheckedByName) {
  EXPECT_THAT(errors_of(std::string(kStage) + "options = { busy_scope = \"everything\" }\n"),
              ElementsAre(StartsWith("lab.toml:4: device.options.busy_scope: ")));
  EXPECT_THAT(errors_of(std::string(kStage) + "speed = 0\n"), ElementsAre(HasSubstr("how many times as fast")));
}

TEST(Config, ASyntaxErrorNamesItsLine) {
  EXPECT_THAT(errors_of("[[device]]\nname = \"stage\n"), ElementsAre(StartsWith("lab.toml:2: is not TOML: ")));
}

TEST(Config, AFileThatIsNotThereSaysSo) {
  const auto config = load_config("/nonexistent/lab.toml", device_kinds());
  ASSERT_FALSE(config);
  EXPECT_EQ(to_string(config.error().at(0)), "/nonexistent/lab.toml: cannot be opened: No such file or directory");
}

TEST(Config, TheExampleThatIsInstalledIsRight) {
  // Parsed with parse_config(), because load_config() also checks the file's owner, which is arbitrary in a source
  // tree.
  const std::string path = paths::in_project("deploy/axisgate.toml");
  const auto text = read_config_file(path);
  ASSERT_TRUE(text) << text.error();
  const auto config = parse_config(*text, path, device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->devices.size(), 1u);
}

TEST(Config, ReadsAFile) {
  const std::string path = ::testing::TempDir() + "axisgate_config_test.toml";
  std::ofstream(path) << kStage;
  const auto config = load_config(path, device_kinds());
  std::remove(path.c_str());
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->devices.at(0).name, "stage");
}

TEST(Config, AFileThatOthersMayWriteIsRefused) {
  const std::string path = ::testing::TempDir() + "axisgate_config_test_open.toml";
  std::ofstream(path) << kStage;
  ASSERT_EQ(::chmod(path.c_str(), 0666), 0);
  const auto config = load_config(path, device_kinds());
  std::remove(path.c_str());
  ASSERT_FALSE(config);
  EXPECT_EQ(to_string(config.error().at(0)),
            path + ": may be written by everybody on this machine, who could change what the daemon does; chmod go-w " +
                path);
}

}  // namespace
}  // namespace axisgate::server::config_test
