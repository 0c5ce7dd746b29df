#include "server/recording/redaction.h"

#include <gmock/gmock.h>

#include "server/kinds.h"

namespace axisgate::server::redaction_test {
namespace {

using Kind = Redactor::Kind;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Redactor, EachSecretHasOneStandIn) {
  Redactor redactor;
  EXPECT_EQ(redactor.hide(Kind::serial_number, "2106001001"), "0000000001");
  EXPECT_EQ(redactor.hide(Kind::serial_number, "2106001002"), "0000000002");
  EXPECT_EQ(redactor.hide(Kind::serial_number, "2106001001"), "0000000001");
  EXPECT_EQ(redactor.hide(Kind::user, "alice"), "user-1");
  EXPECT_EQ(redactor.hide(Kind::user, "bob"), "user-2");
  EXPECT_EQ(redactor.hide(Kind::user, "alice"), "user-1");
  EXPECT_EQ(redactor.hide(Kind::host, "moxa.lab"), "host-1");
  EXPECT_EQ(redactor.hide(Kind::path, "/data/alice/stage.recording"), "/path-1");
  EXPECT_EQ(redactor.hide(Kind::path, ""), "");
  EXPECT_EQ(redactor.summary(), "2 serial numbers, 2 users, 1 host, 1 path");
}

TEST(Redactor, ATtyStaysButForASerialNumberInItsName) {
  Redactor redactor;
  EXPECT_EQ(redactor.hide(Kind::path, "/dev/ttyUSB0"), "/dev/ttyUSB0");
  EXPECT_EQ(redactor.hide(Kind::path, "/dev/serial/by-id/usb-FTDI_A10XXXXX-if00-port0"), "/dev/serial/by-id/path-1");
}

TEST(Redactor, WhatIsKnownIsReplacedInAnyText) {
  Redactor redactor;
  redactor.hide(Kind::host, "moxa");
  redactor.hide(Kind::host, "moxa.lab");
  redactor.hide(Kind::serial_number, "1234");
  EXPECT_EQ(redactor.redact("no answer from moxa.lab:4001 or moxa"), "no answer from host-2:4001 or host-1");
  EXPECT_EQ(redactor.redact("1234, not 12345 or 01234"), "0001, not 12345 or 01234");
  EXPECT_EQ(redactor.redact("SHRC-203 9876 answers, but SHRC-203 1234 is configured"),
            "SHRC-203 0002 answers, but SHRC-203 0001 is configured");
}

TEST(Redactor, CallersOfARecordingAreReplacedWhoeverTheyAre) {
  Redactor redactor;
  EXPECT_EQ(redactor.redact("1.000000 #1 poll \"\" > \"Q:S\\r\\n\"\n"
                            "1.050000 #1 poll \"gateway\" > \"Q:S\\r\\n\"\n"
                            "1.100000 #2 motion \"unix alice\" waited 0.000100 > \"alice\" = ok\n"
                            "1.200000 #3 question \"tcp 127.0.0.1:39482\" > \"Q:S\\r\\n\"\n"
                            "1.300000 #2 < \"unix alice\"\n"
                            "1.400000 - unexpected \"alice\"\n"
                            "1.500000 #4 stop \"unix uid 1234\" > \"L:W\\r\\n\"\n"
                            "1.550000 #4 stop \"token night-scan\" > \"L:W\\r\\n\"\n"
                            "1.600000 #5 stop \"a \\\"b\\\" c\" > \"L:W\\r\\n\"\n"
                            "1.700000 #6 motion \"unix alice\" > \"G:1\\r\\n\""),
            "1.000000 #1 poll \"\" > \"Q:S\\r\\n\"\n"
            "1.050000 #1 poll \"gateway\" > \"Q:S\\r\\n\"\n"
            "1.100000 #2 motion \"unix user-1\" waited 0.000100 > \"alice\" = ok\n"
            "1.200000 #3 question \"tcp user-2\" > \"Q:S\\r\\n\"\n"
            "1.300000 #2 < \"unix alice\"\n"
            "1.400000 - unexpected \"alice\"\n"
            "1.500000 #4 stop \"unix user-3\" > \"L:W\\r\\n\"\n"
            "1.550000 #4 stop \"token user-4\" > \"L:W\\r\\n\"\n"
            "1.600000 #5 stop \"user-5\" > \"L:W\\r\\n\"\n"
            "1.700000 #6 motion \"unix user-1\" > \"G:1\\r\\n\"");
}

TEST(Redactor, SerialNumbersAreFoundInPieces) {
  Redactor redactor;
  const std::string clean = redactor.redact(
      "# serial-number: \"2106001001\"\n"
      "1.000000 - > \"*IDN?\\r\\n\" +0.001000 < \"SIGMAKOKI,SHRC-203,2106\" +0.002000 < \"001001,V1.00\\r\\n\"\n"
      "2.000000 #1 question \"\" > \"?:SN\\r\\n\" +0.001000 < \"210600100\"\n"
      "2.500000 #1 < \"1\\r\\n\" = data\n"
      "3.000000 #2 question \"\" > \"?:SN\\r\\n\" +0.001000 < \"2106001001\\r\\n\" = data\n");
  EXPECT_EQ(clean,
            "# serial-number: \"0000000001\"\n"
            "1.000000 - > \"*IDN?\\r\\n\" +0.001000 < \"SIGMAKOKI,SHRC-203,0000\" +0.002000 < \"000001,V1.00\\r\\n\"\n"
            "2.000000 #1 question \"\" > \"?:SN\\r\\n\" +0.001000 < \"000000000\"\n"
            "2.500000 #1 < \"1\\r\\n\" = data\n"
            "3.000000 #2 question \"\" > \"?:SN\\r\\n\" +0.001000 < \"0000000001\\r\\n\" = data\n");
  EXPECT_EQ(redactor.redact("1.000000 - < \"SIGMAKOKI,SHRC-203,21060\"\n"),
            "1.000000 - < \"SIGMAKOKI,SHRC-203,00002\"\n");
}

TEST(Redactor, AConfigurationKeepsWhatIsNoSecret) {
  const Configured<Config> config = parse_config(R"(
socket = "/run/user/1000/axisgate.sock"
[[device]]
name = "stage"
connection = "serial"
path = "/dev/serial/by-id/usb-FTDI_A10XXXXX-if00-port0"
serial_number = "2106001001"
record = "/data/alice/stage.recording"
[[device]]
name = "far"
connection = "tcp"
host = "moxa.lab"
port = 4001
)",
                                                 "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  Redactor redactor;
  const Config clean = redactor.redact(*config);
  EXPECT_EQ(clean.socket, "/path-1");
  EXPECT_EQ(clean.devices[0].name, "stage");
  EXPECT_EQ(std::get<StageConfig>(clean.devices[0].family).profile.serial_number, "0000000001");
  EXPECT_EQ(std::get<SerialSettings>(clean.devices[0].connection).path, "/dev/serial/by-id/path-3");
  EXPECT_EQ(clean.devices[0].record, "/path-2");
  EXPECT_EQ(std::get<TcpSettings>(clean.devices[1].connection).host, "host-1");
  EXPECT_EQ(std::get<TcpSettings>(clean.devices[1].connection).port, 4001);
}

TEST(Redactor, CallersOfTheConfiguration) {
  Redactor redactor;
  Config config = default_config(device_kinds());
  config.access.roles = {{"unix alice", Role::admin}};
  EXPECT_EQ(redactor.redact(config).access.roles, (std::map<std::string, Role>{{"unix user-1", Role::admin}}));
}

TEST(Redactor, CallersWhoseTravelIsNarrowerButNotRoles) {
  Redactor redactor;
  Config config = default_config(device_kinds());
  config.access.roles = {{"unix alice", Role::operator_}};
  auto& theirs = std::get<StageConfig>(config.devices[0].family).profile.axes[1].overrides;
  for (const char* whose : {"operator", "unix alice", "token night-scan"}) theirs.emplace_back().whose = whose;
  const Config clean = redactor.redact(config);
  const auto& hidden = std::get<StageConfig>(clean.devices[0].family).profile.axes[1].overrides;
  EXPECT_EQ(hidden[0].whose, "operator");
  EXPECT_EQ(hidden[1].whose, "unix user-1") << "the same as in [access]";
  EXPECT_EQ(hidden[2].whose, "token user-2");
}

TEST(Redactor, CallersAtTheStationOfAMill) {
  Redactor redactor;
  Config config = default_config(device_kinds());
  config.access.roles = {{"unix alice", Role::operator_}};
  MillConfig mill;
  mill.profile_name = "mdx-20";
  mill.station = {"unix", "unix alice", "token anna"};
  config.devices[0].family = mill;
  const auto clean = std::get<MillConfig>(redactor.redact(config).devices[0].family);
  EXPECT_EQ(clean.station, (std::vector<std::string>{"unix", "unix user-1", "token user-2"}));
  EXPECT_EQ(clean.profile_name, "mdx-20");
}

}  // namespace
}  // namespace axisgate::server::redaction_test
