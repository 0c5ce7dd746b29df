#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "device/config/config_file.h"
#include "server/config/mill.h"
#include "server/config/text.h"
#include "server/kinds.h"
#include "server/recording/redaction.h"
#include "tests/paths/paths.h"

namespace axisgate::server::config_mill_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// Added lines begin in line 6.
constexpr const char* kSerial =
    "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"serial\"\n";
constexpr const char* kSimulated =
    "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"simulated\"\n";
constexpr const char* kPath = "path = \"/dev/ttyUSB0\"\n";
constexpr const char* kProfileRule = "the name of a profile, \"mdx-20\", or the absolute path of a file";
constexpr const char* kStationRule =
    "\"unix\", everybody on this machine's Unix socket, or a caller, \"unix LOGIN\", \"cert NAME\" or \"token NAME\"";

Configured<Config> parse(const std::string& text) { return parse_config(text, "lab.toml", device_kinds()); }

std::vector<std::string> errors_of(const std::string& text) {
  std::vector<std::string> lines;
  if (const auto config = parse(text); !config) {
    for (const ConfigError& error : config.error()) lines.push_back(to_string(error));
  }
  return lines;
}

// Returns the errors of a serial mill with the added keys.
std::vector<std::string> errors_with(const std::string& added) {
  return errors_of(std::string(kSerial) + kPath + added);
}

MillConfig mill_of(const Config& config) { return std::get<MillConfig>(config.devices.at(0).family); }

constexpr const char* kWhole = R"([[device]]
name = "mill"
kind = "rml1"
profile = "mdx-20"
connection = "serial"
path = "/dev/ttyUSB0"
baud = 19200
parity = "even"
stop_bits = 2
record = "/var/tmp/mill.recording"
streaming = "full"
window = 128
buffer = 2048
converter = 0
slack = "measured"
station = ["unix alice", "cert Ann Lee", "token anna", "unix uid 1000"]
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
x = 8128
y = 6096
)";

TEST(ConfigMill, IsReadWhole) {
  const auto config = parse(kWhole);
  ASSERT_TRUE(config) << to_string(config.error().front());
  const DeviceConfig& device = config->devices.at(0);
  EXPECT_EQ(device.name, "mill");
  EXPECT_EQ(device.baud, 19'200);
  EXPECT_EQ(device.record, "/var/tmp/mill.recording");
  const auto& serial = std::get<SerialSettings>(device.connection);
  EXPECT_EQ(serial.path, "/dev/ttyUSB0");
  EXPECT_EQ(serial.baud, 19'200);
  EXPECT_EQ(serial.parity, Parity::even);
  EXPECT_EQ(serial.flow, FlowControl::rts_cts);
  const MillConfig mill = mill_of(*config);
  EXPECT_EQ(mill.kind->name(), "rml1");
  EXPECT_EQ(mill.profile_name, "mdx-20");
  EXPECT_EQ(mill.model->name(), "MDX-20");
  EXPECT_EQ(mill.sending.streaming, jobs::Streaming::full);
  EXPECT_EQ(mill.sending.window, 128u);
  EXPECT_EQ(mill.sending.buffer, 2048u);
  EXPECT_EQ(mill.sending.converter, 0u);
  EXPECT_TRUE(mill.sending.slack_as_measured);
  EXPECT_EQ(mill.sending.slack, 1.5) << "as long as nothing is measured";
  EXPECT_EQ(mill.sending.baud, 19'200);
  EXPECT_THAT(mill.station, ElementsAre("unix alice", "cert Ann Lee", "token anna", "unix uid 1000"));
  EXPECT_EQ(mill.confirmation, std::chrono::minutes(5));
  EXPECT_THAT(mill.tools, ElementsAre("T1", "ball-nose_3"));
  EXPECT_EQ(mill.busy_limit, std::chrono::minutes(1));
  EXPECT_EQ(mill.at_loss, jobs::AtLoss::leave);
  EXPECT_EQ(mill.at_exit, MillConfig::AtExit::finish);
  ASSERT_EQ(mill.origins.size(), 2u);
  EXPECT_EQ(mill.origins[0].name, "vice");
  EXPECT_EQ(mill.origins[0].x, 400);
  EXPECT_EQ(mill.origins[1].y, 6096);
  EXPECT_EQ(mill.origins[0].z, -800);
  EXPECT_EQ(mill.origins[1].z, std::nullopt);
}

// Full streaming is the default only if the line can hold the host back; a window selects paced streaming.
TEST(ConfigMill, TheUsualStreaming) {
  const auto is_full = [](const std::string& added) {
    const auto config = parse(std::string(kSerial) + kPath + added);
    return config && mill_of(*config).sending.streaming == jobs::Streaming::full;
  };
  EXPECT_TRUE(is_full("flow_control = \"xonxoff\"\n"));
  EXPECT_TRUE(is_full("flow_control = \"rtscts\"\n"));
  EXPECT_TRUE(is_full("flow_control = \"rtscts\"\nwindow = 128\nstreaming = \"full\"\n"));
  EXPECT_FALSE(is_full("flow_control = \"rtscts\"\nwindow = 128\n"));
  for (const std::string flow : {"none", "dtr_dsr"}) EXPECT_FALSE(is_full("flow_control = \"" + flow + "\"\n"));
}

TEST(ConfigMill, Defaults) {
  const auto config = parse(std::string(kSerial) + kPath);
  ASSERT_TRUE(config) << to_string(config.error().front());
  const MillConfig mill = mill_of(*config);
  EXPECT_EQ(mill.sending.streaming, jobs::Streaming::paced);
  EXPECT_EQ(mill.sending.window, 0u) << "chosen from the job";
  EXPECT_EQ(mill.sending.buffer, 1024u);
  EXPECT_EQ(mill.sending.converter, 512u);
  EXPECT_EQ(mill.sending.slack, 1.5);
  EXPECT_FALSE(mill.sending.slack_as_measured);
  EXPECT_THAT(mill.station, ElementsAre("unix"));
  EXPECT_EQ(mill.confirmation, std::chrono::minutes(10));
  EXPECT_THAT(mill.tools, ElementsAre("T1"));
  EXPECT_THAT(mill.origins, IsEmpty());
  EXPECT_EQ(mill.busy_limit, std::chrono::minutes(10));
  EXPECT_EQ(mill.at_loss, jobs::AtLoss::abort);
  EXPECT_EQ(mill.at_exit, MillConfig::AtExit::abort);
  EXPECT_EQ(mill.slower_percent, 0);
}

TEST(ConfigMill, WithoutABaudRateItIsThatOfTheProfile) {
  const auto of_profile = parse(std::string(kSerial) + kPath);
  ASSERT_TRUE(of_profile) << to_string(of_profile.error().front());
  EXPECT_EQ(of_profile->devices.at(0).baud, 9600) << "deploy/mills/mdx-20.toml has it";
  EXPECT_EQ(std::get<SerialSettings>(of_profile->devices.at(0).connection).baud, 9600);
  EXPECT_EQ(mill_of(*of_profile).sending.baud, 9600);
  const auto without = parse(
      "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"srm-20\"\nconnection = \"tcp\"\n"
      "host = \"moxa.lab\"\nport = 4001\n");
  ASSERT_TRUE(without) << to_string(without.error().front());
  EXPECT_FALSE(mill_of(*without).model->baud());
  EXPECT_EQ(without->devices.at(0).baud, jobs::SendSettings{}.baud);
}

TEST(ConfigMill, NumbersAndWordsAreChecked) {
  EXPECT_THAT(
      errors_with("streaming = \"fast\"\nwindow = 15\nbuffer = 1048577\nconverter = -1\nconfirmation_minutes = 0\n"
                  "busy_limit_s = 9\nat_exit = \"stop\"\n"),
      ElementsAre("lab.toml:7: device.streaming: \"fast\" is not known; use one of \"paced\", \"full\"",
                  "lab.toml:8: device.window: 15 is out of range; use a whole number from 16 to 4096",
                  "lab.toml:9: device.buffer: 1048577 is out of range; use a whole number from 16 to 1048576",
                  "lab.toml:10: device.converter: -1 is out of range; use a whole number from 0 to 65536",
                  "lab.toml:11: device.confirmation_minutes: 0 is out of range; use a whole number from 1 to 1440",
                  "lab.toml:12: device.busy_limit_s: 9 is out of range; use a whole number from 10 to 86400",
                  "lab.toml:13: device.at_exit: \"stop\" is not known; use one of \"abort\", \"finish\""));
  EXPECT_THAT(errors_with("window = 4097\nbuffer = 15\nconverter = 65537\nconfirmation_minutes = 1441\n"
                          "busy_limit_s = 86401\n"),
              ElementsAre(HasSubstr(":7: device.window: 4097 is out of range"),
                          HasSubstr(":8: device.buffer: 15 is out of range"),
                          HasSubstr(":9: device.converter: 65537 is out of range"),
                          HasSubstr(":10: device.confirmation_minutes: 1441 is out of range"),
                          HasSubstr(":11: device.busy_limit_s: 86401 is out of range")));
  EXPECT_THAT(errors_with("window = 4096\nbuffer = 1048576\nconverter = 65536\nconfirmation_minutes = 1440\n"
                          "busy_limit_s = 86400\n"),
              IsEmpty());
  EXPECT_THAT(errors_with("window = 16\nbuffer = 16\nconverter = 0\nconfirmation_minutes = 1\nbusy_limit_s = 10\n"),
              IsEmpty());
}

TEST(ConfigMill, AWindowFitsTheBuffer) {
  EXPECT_THAT(
      errors_with("buffer = 128\nwindow = 129\n"),
      ElementsAre("lab.toml:8: device.window: 129 bytes do not fit the mill's buffer of 128 bytes; use a window "
                  "that does"));
}

TEST(ConfigMill, AProfileIsRequired) {
  EXPECT_THAT(errors_of("[[device]]\nname = \"mill\"\nkind = \"rml1\"\nconnection = \"simulated\"\n"),
              ElementsAre(std::string("lab.toml:1: device.profile: is missing; use ") + kProfileRule));
}

TEST(ConfigMill, AProfileIsOneThatThereIs) {
  const auto errors_of_profile = [](const std::string& profile) {
    return errors_of("[[device]]\nname = \"mill\"\nkind = \"rml1\"\nconnection = \"simulated\"\nprofile = \"" +
                     profile + "\"\n");
  };
  EXPECT_THAT(errors_of_profile("MDX-20"), IsEmpty()) << "in either case";
  EXPECT_THAT(errors_of_profile("mdx-21"),
              ElementsAre("lab.toml:5: device.profile: there is no profile \"mdx-21\"; use mdx-15, mdx-20, mdx-40, "
                          "mdx-50, mdx-540, srm-20, or the file of a profile"));
  for (const std::string path : {"mills/own.toml", "own.toml", "./own"}) {
    EXPECT_THAT(errors_of_profile(path), ElementsAre("lab.toml:5: device.profile: \"" + path +
                                                     "\" is not an absolute path; use " + kProfileRule));
  }
  EXPECT_THAT(
      errors_of_profile("/nonexistent/own.toml"),
      ElementsAre(std::string("lab.toml:5: device.profile: /nonexistent/own.toml cannot be opened: No such file "
                              "or directory; use ") +
                  kProfileRule));
}

// A profile file in its own folder.
class ConfigMillProfile : public testing::Test {
 protected:
  ConfigMillProfile() { std::filesystem::create_directories(folder); }
  ~ConfigMillProfile() override { std::filesystem::remove_all(folder); }

  std::string text() const {
    return "[[device]]\nname = \"mill\"\nkind = \"rml1\"\nconnection = \"simulated\"\nprofile = \"" + file +
           "\"\nwindow = 1\n";
  }

  const std::string folder = testing::TempDir() + "axisgate_config_mill_test";
  const std::string file = folder + "/own.toml";
};

TEST_F(ConfigMillProfile, ErrorsInItAreAtItsOwnLinesAndLast) {
  std::ofstream(file) << "name = \"\"\nstep_mm = 0\n[area]\nx_mm = 1\ny_mm = 1\nz_mm = 1\n";
  const auto errors = errors_of(text());
  ASSERT_GE(errors.size(), 3u);
  EXPECT_THAT(errors[0], StartsWith("lab.toml:6: device.window: 1 is out of range"));
  EXPECT_THAT(errors[1], StartsWith(file + ":1: name: is empty"));
  std::ofstream(file) << "name = \"Own\nstep_mm = 1\n";
  EXPECT_THAT(errors_of(text()), ElementsAre(HasSubstr("device.window"), StartsWith(file + ":1: is not TOML: ")));
}

TEST_F(ConfigMillProfile, AFileIsReadAndItsPathWrittenAndHidden) {
  std::filesystem::copy_file(paths::in_project("deploy/mills/mdx-50.toml"), file);
  std::string good = text();
  good.erase(good.find("window"));
  const auto config = parse(good);
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(mill_of(*config).model->name(), "MDX-50");
  EXPECT_THAT(to_toml(*config), HasSubstr("profile = \"" + file + "\"\n"));
  EXPECT_EQ(mill_of(Redactor().redact(*config)).profile_name, "/path-2") << "the socket has the first";
}

TEST(ConfigMill, OnlyCallersCanConfirm) {
  for (const char* station : {"[\"unix\"]", "[\"unix alice\", \"token anna\"]", "[\"cert Ann Lee\", \"unix\"]"}) {
    EXPECT_THAT(errors_with(std::string("station = ") + station + "\n"), IsEmpty()) << station;
  }
  const auto error = [](const std::string& what) {
    return "lab.toml:7: device.station: " + what + "; use " + kStationRule;
  };
  EXPECT_THAT(errors_with("station = []\n"), ElementsAre(error("is empty, so nobody could confirm at the mill")));
  for (const std::string name : {"alice", "operator", "Unix", ""}) {
    EXPECT_THAT(errors_with("station = [\"" + name + "\"]\n"),
                ElementsAre(error("\"" + name + "\" is not a caller as the daemon names them")));
  }
  EXPECT_THAT(errors_with("station = [\"token night scan\", \"unix\", \"unix Ann Lee\", \"cert \"]\n"),
              ElementsAre(error("\"token night scan\" is not a token's name"), error("\"unix Ann Lee\" is not a login"),
                          error("\"cert \" names nobody")));
  EXPECT_THAT(errors_with("station = [\"tcp 127.0.0.1:39482\"]\n"),
              ElementsAre(error("\"tcp 127.0.0.1:39482\" is known by an address only, which everybody on this machine "
                                "may have")));
  EXPECT_THAT(errors_with("station = \"unix\"\n"), ElementsAre(HasSubstr("use a list of texts")));
}

TEST(ConfigMill, ToolsHaveNamesThatDiffer) {
  EXPECT_THAT(errors_with("tools = []\n"),
              ElementsAre("lab.toml:7: device.tools: is empty; use at least one name, [\"T1\"]"));
  EXPECT_THAT(errors_with("tools = [\"1\", \"T1\", \"T1\"]\n"),
              ElementsAre(StartsWith("lab.toml:7: device.tools: \"1\" is not a name; use a letter, then letters"),
                          "lab.toml:7: device.tools: \"T1\" is the name of another tool, too; names must differ"));
}

TEST(ConfigMill, OriginsLieWithinTheWorkArea) {
  EXPECT_THAT(errors_with("[[device.origin]]\n"),
              ElementsAre(StartsWith("lab.toml:7: device.origin.name: is missing; use a letter"),
                          "lab.toml:7: device.origin.x: is missing; use the mill's steps from its home corner, a whole "
                          "number from 0 to 8128",
                          "lab.toml:7: device.origin.y: is missing; use the mill's steps from its home corner, a whole "
                          "number from 0 to 6096"));
  EXPECT_THAT(
      errors_with("[[device.origin]]\nname = \"2\"\nx = 8129\ny = -1\n"
                  "[[device.origin]]\nname = \"vice\"\nx = \"10mm\"\ny = 0\nz = 1\nw = 0\n"
                  "[[device.origin]]\nname = \"vice\"\nx = 0\ny = 0\n"),
      ElementsAre(StartsWith("lab.toml:8: device.origin.name: \"2\" is not a name; use a letter"),
                  "lab.toml:9: device.origin.x: 8129 is out of range; use a whole number from 0 to 8128",
                  "lab.toml:10: device.origin.y: -1 is out of range; use a whole number from 0 to 6096",
                  StartsWith("lab.toml:13: device.origin.x: the text \"10mm\" will not do"),
                  "lab.toml:15: device.origin.z: 1 is out of range; use a whole number from -2420 to 0",
                  "lab.toml:16: device.origin.w: is not a key here; use name, x, y, z",
                  "lab.toml:18: device.origin.name: \"vice\" is the name of another origin of this device, too"));
}

TEST(ConfigMill, KeysOfStagesAreUnknown) {
  for (const std::string key :
       {"idle_poll_ms = 100", "moving_poll_ms = 100", "reply_limit_ms = 500", "serial_number = \"7\"",
        "settings_at_lease_end = \"kept\"", "busy_scope = \"axis\"", "wait_for_inputs = true", "slower = 10"}) {
    EXPECT_THAT(errors_with(key + "\n"), ElementsAre(StartsWith("lab.toml:7: device." + key.substr(0, key.find(' ')) +
                                                                ": is not a key here; use name, kind, profile")));
  }
  EXPECT_THAT(errors_with("[[device.axis]]\nnumber = 1\n"),
              ElementsAre(StartsWith("lab.toml:7: device.axis: is not a key here; use name, kind, profile")));
}

TEST(ConfigMill, KeysOfMillsAreUnknownToStages) {
  for (const std::string key :
       {"profile = \"mdx-20\"", "streaming = \"full\"", "window = 64", "buffer = 64", "converter = 0",
        "station = [\"unix\"]", "confirmation_minutes = 5", "tools = [\"T1\"]", "busy_limit_s = 60", "slower = 10"}) {
    EXPECT_THAT(errors_of("[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n" + key + "\n"),
                ElementsAre(StartsWith("lab.toml:4: device." + key.substr(0, key.find(' ')) +
                                       ": is not a key here; use name, kind, connection")));
  }
  EXPECT_THAT(errors_of("[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n[[device.origin]]\nname = \"a\"\n"),
              ElementsAre(StartsWith("lab.toml:4: device.origin: is not a key here")));
}

TEST(ConfigMill, ASimulatedOneHasSpeedOptionsAndIsSlower) {
  const auto config = parse(std::string(kSimulated) +
                            "speed = 10\nbaud = 9600\nslower = 12.5\noptions = { escape_k = \"one-shot\" }\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  const auto& simulated = std::get<SimulatedConnection>(config->devices.at(0).connection);
  EXPECT_EQ(simulated.speed, 10);
  EXPECT_TRUE(simulated.paced);
  EXPECT_THAT(simulated.options, ElementsAre(std::pair<std::string, std::string>("escape_k", "one-shot")));
  EXPECT_EQ(mill_of(*config).slower_percent, 12.5);
  EXPECT_THAT(
      errors_of(std::string(kSimulated) + "slower = 1001\noptions = { escape_k = \"never\", colour = \"red\" }\n"),
      ElementsAre("lab.toml:6: device.slower: 1001 will not do; use percent from 0 to 1000",
                  StartsWith("lab.toml:7: device.options.colour: The simulated mill has no option 'colour'. Name "
                             "one of: escape_k, "),
                  "lab.toml:7: device.options.escape_k: The option 'escape_k' of the simulated mill cannot be "
                  "'never'. Give one of: toggle, one-shot, in-band."));
}

TEST(ConfigMill, WithoutAConnectionNoKeyOfOneIsUnknown) {
  EXPECT_THAT(
      errors_of("[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nslower = 10\nspeed = 2\n"
                "path = \"/dev/ttyS0\"\nstreaming = \"full\"\n"),
      ElementsAre("lab.toml:1: device.connection: is missing; use \"serial\", \"tcp\", \"simulated\" or \"printer\""));
}

TEST(ConfigMill, SharesNoLineWithAStage) {
  EXPECT_THAT(errors_with("[[device]]\nname = \"stage\"\nconnection = \"serial\"\npath = \"/dev/ttyUSB0\"\n"),
              ElementsAre(HasSubstr("device.path: \"/dev/ttyUSB0\" is the line of another device")));
}

TEST(ConfigMill, IsOfferedAmongTheKinds) {
  EXPECT_THAT(errors_of("[[device]]\nname = \"m\"\nkind = \"gcode\"\nconnection = \"simulated\"\n"),
              ElementsAre("lab.toml:3: device.kind: \"gcode\" is not known; use one of \"shrc203\", \"rml1\""));
  const DeviceKinds stages_only{.stages = device_kinds().stages};
  EXPECT_FALSE(parse_config(std::string(kSimulated), "lab.toml", stages_only));
}

TEST(ConfigMill, TheExampleIsRight) {
  const std::string path = paths::in_project("deploy/mill.toml");
  const auto text = read_config_file(path);
  ASSERT_TRUE(text) << text.error();
  const auto config = parse_config(*text, path, device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  ASSERT_EQ(config->devices.size(), 1u);
  // The keys that are commented out show the defaults, so the configuration stays the same with them.
  std::string whole;
  for (std::size_t at = 0; at < text->size();) {
    const std::size_t end = std::min(text->find('\n', at), text->size());
    const std::string line = text->substr(at, end - at);
    const bool key =
        line.starts_with("# ") && line.find(" = ") != std::string::npos && line.find(" = ") == line.find(' ', 2);
    whole += (key ? line.substr(2) : line) + "\n";
    at = end + 1;
  }
  ASSERT_NE(whole, *text);
  auto shown = parse_config(whole, path, device_kinds());
  ASSERT_TRUE(shown) << to_string(shown.error().front());
  EXPECT_EQ(shown->devices[0].record, "/var/tmp/mill.recording") << "an example";
  shown->devices[0].record.clear();
  auto& shown_mill = std::get<MillConfig>(shown->devices[0].family);
  EXPECT_EQ(shown_mill.sending.window, 128u) << "an example, too";
  shown_mill.sending.window = 0;
  EXPECT_EQ(to_toml(*shown), to_toml(*config));
}

}  // namespace
}  // namespace axisgate::server::config_mill_test
