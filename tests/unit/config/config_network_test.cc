#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "server/config/config.h"
#include "server/connections/certificates.h"
#include "server/kinds.h"
#include "tests/certificates/authority.h"

namespace axisgate::server::config_network_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class ConfigNetwork : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_);
    Authority(folder_, "lab").issue("gateway");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  static Configured<Config> read(const std::string& lines) {
    return parse_config("[network]\n" + lines + "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n",
                        "lab.toml", device_kinds());
  }

  static std::vector<std::string> errors_of(const std::string& lines) {
    std::vector<std::string> errors;
    if (const auto config = read(lines); !config) {
      for (const ConfigError& error : config.error()) errors.push_back(to_string(error));
    }
    return errors;
  }

  std::string keys(const std::string& certificate, const std::string& key) const {
    return "listen = \"0.0.0.0:50204\"\ncertificate = \"" + path(certificate) + "\"\nkey = \"" + path(key) + "\"\n";
  }

  const std::string folder_ = ::testing::TempDir() + "axisgate-network-" + std::to_string(::getpid());
};

TEST_F(ConfigNetwork, IsReadWhole) {
  const auto config = read(keys("gateway.crt", "gateway.key") + "client_ca = \"" + path("lab.crt") + "\"\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(to_string(config->network->listen), "0.0.0.0:50204");
  EXPECT_EQ(config->network->certificate, path("gateway.crt"));
  EXPECT_EQ(config->network->key, path("gateway.key"));
  EXPECT_EQ(config->network->client_ca, path("lab.crt"));
}

TEST_F(ConfigNetwork, WithoutCertificateAndKeyItIsRefused) {
  EXPECT_THAT(errors_of("listen = \"0.0.0.0:50204\"\n"),
              ElementsAre(StartsWith("lab.toml:1: network.certificate: is missing; use the PEM file"),
                          StartsWith("lab.toml:1: network.key: is missing; use the PEM file")));
}

TEST_F(ConfigNetwork, TheAddressIsAnAddress) {
  const std::string files = "certificate = \"" + path("gateway.crt") + "\"\nkey = \"" + path("gateway.key") + "\"\n";
  EXPECT_THAT(errors_of(files), ElementsAre(StartsWith("lab.toml:1: network.listen: is missing; use ADDRESS:PORT")));
  for (const std::string wrong : {"0.0.0.0", "gateway.lab:50204", "0.0.0.0:65536", ":50204"}) {
    EXPECT_THAT(errors_of("listen = \"" + wrong + "\"\n" + files),
                ElementsAre(StartsWith("lab.toml:2: network.listen: \"" + wrong + "\" is not ADDRESS:PORT")));
  }
}

TEST_F(ConfigNetwork, FilesAreCheckedBeforeAnybodyIsServed) {
  Authority(folder_, "lab").issue("other");
  std::ofstream(path("empty.crt")) << "nothing\n";
  std::ofstream(path("damaged.crt")) << std::ifstream(path("gateway.crt")).rdbuf()
                                     << "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n";
  EXPECT_THAT(errors_of(keys("gone.crt", "gateway.key")),
              ElementsAre(AllOf(StartsWith("lab.toml:3: network.certificate: "), HasSubstr("gone.crt cannot be opened: "
                                                                                           "No such file"))));
  EXPECT_THAT(errors_of(keys("empty.crt", "gateway.key")), ElementsAre(HasSubstr("empty.crt holds no certificate")));
  EXPECT_THAT(errors_of(keys("damaged.crt", "gateway.key")), ElementsAre(HasSubstr("damaged.crt is damaged")));
  EXPECT_THAT(errors_of(keys("gateway.crt", "gateway.crt")), ElementsAre(HasSubstr("holds no private key")));
  EXPECT_THAT(errors_of(keys("gateway.crt", "other.key")),
              ElementsAre(AllOf(StartsWith("lab.toml:4: network.key: "), HasSubstr("is not the key of"))));
  std::filesystem::permissions(path("gateway.key"), std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  EXPECT_THAT(errors_of(keys("gateway.crt", "gateway.key")),
              ElementsAre(AllOf(HasSubstr("may be read or written by everybody"), HasSubstr("chmod o= "))));
}

TEST_F(ConfigNetwork, AKeyThatAnotherGroupMayWriteIsRefused) {
  const std::string key = path("gateway.key");
  if (::chown(key.c_str(), static_cast<uid_t>(-1), ::getegid() + 7) != 0) GTEST_SKIP() << "only root gives files away";
  ASSERT_EQ(::chmod(key.c_str(), 0640), 0);
  EXPECT_THAT(errors_of(keys("gateway.crt", "gateway.key")), ElementsAre());
  ASSERT_EQ(::chmod(key.c_str(), 0660), 0);
  EXPECT_THAT(errors_of(keys("gateway.crt", "gateway.key")),
              ElementsAre(AllOf(HasSubstr(key + " may be written by the members of the group"),
                                HasSubstr("chmod go-w " + key))));
}

TEST_F(ConfigNetwork, AKeyOfAnotherUserIsRefused) {
  const std::string key = path("gateway.key");
  if (::chown(key.c_str(), ::geteuid() + 7, static_cast<gid_t>(-1)) != 0) GTEST_SKIP() << "only root gives files away";
  EXPECT_THAT(errors_of(keys("gateway.crt", "gateway.key")), ElementsAre(HasSubstr(key + " belongs to the user ")));
}

TEST_F(ConfigNetwork, ExpiryIsThatOfTheFirstCertificate) {
  const auto lab = std::chrono::hours(24), short_lived = std::chrono::hours(2);
  Authority(folder_, "lab").issue("brief", short_lived);
  const WallTime now = calendar_now();
  EXPECT_NEAR(static_cast<double>((*expiry(path("brief.crt")) - now - short_lived) / std::chrono::seconds(1)), 0, 60);
  EXPECT_NEAR(static_cast<double>((*expiry(path("lab.crt")) - now - lab) / std::chrono::seconds(1)), 0, 60);
}

}  // namespace
}  // namespace axisgate::server::config_network_test
