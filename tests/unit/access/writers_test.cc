// Permissions of files that decide what the daemon does: who else may write them.
#include "server/access/writers.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace axisgate::server::writers_test {
namespace {

struct stat of(mode_t mode, uid_t owner = ::geteuid(), gid_t group = ::getegid()) {
  struct stat status {};
  status.st_mode = S_IFREG | mode;
  status.st_uid = owner;
  status.st_gid = group;
  return status;
}

std::string why(const struct stat& status) {
  const Result<void> checked = check_writers("/etc/lab.toml", status);
  return checked ? "" : checked.error().message + "; " + checked.error().hint;
}

TEST(Writers, WhatUsualMasksLeaveIsAccepted) {
  for (const mode_t mode : {0400, 0600, 0640, 0644, 0755}) EXPECT_EQ(why(of(mode)), "") << std::oct << mode;
  EXPECT_EQ(why(of(0644, 0, 0)), "") << "what root has installed";
  EXPECT_EQ(why(of(0664)), "") << "umask 002, in the daemon's own group";
}

TEST(Writers, EverybodyIsRefused) {
  const std::string refused =
      "may be written by everybody on this machine, who could change what the daemon does; chmod go-w /etc/lab.toml";
  EXPECT_EQ(why(of(0666)), refused);
  EXPECT_EQ(why(of(0602)), refused);
  EXPECT_EQ(why(of(01777, 0, 0)), refused) << "a sticky directory lets everybody make the file first";
}

TEST(Writers, AnotherGroupIsRefused) {
  EXPECT_EQ(why(of(0664, ::geteuid(), ::getegid() + 7)),
            "may be written by the members of the group " + std::to_string(::getegid() + 7) +
                ", who could change what the daemon does; chmod go-w /etc/lab.toml");
}

TEST(Writers, AnotherOwnerIsRefusedAlsoOfWhatIsReadOnly) {
  const std::string other = std::to_string(::geteuid() + 7), own = std::to_string(::geteuid());
  EXPECT_EQ(why(of(0400, ::geteuid() + 7)), "belongs to the user " + other + " (the daemon runs as " + own +
                                                "), who could change what the daemon does; chown " + own +
                                                " /etc/lab.toml");
}

TEST(Writers, OfAPath) {
  const std::string path = testing::TempDir() + "axisgate-writers-" + std::to_string(::getpid());
  EXPECT_TRUE(check_writers(path)) << "who opens it says that it is not there";
  std::ofstream(path) << "text";
  ASSERT_EQ(::chmod(path.c_str(), 0644), 0);
  EXPECT_TRUE(check_writers(path));
  ASSERT_EQ(::chmod(path.c_str(), 0646), 0);
  EXPECT_FALSE(check_writers(path));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace axisgate::server::writers_test
