#include "server/connections/endpoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "tests/unit/connections/connection_fixtures.h"

namespace axisgate::server::endpoints_test {
namespace {

using ::testing::HasSubstr;

TEST(Endpoints, AnyFreePortIsNamedAndOneInUseIsRefused) {
  for (const char* host : {"127.0.0.1", "::1"}) {
    TcpAddress address{host, 0};
    const Result<Descriptor> first = listen_on(address);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_NE(address.port, 0);
    const Result<Descriptor> second = listen_on(address);
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message, HasSubstr("in use"));
    EXPECT_THAT(second.error().hint, HasSubstr("another axisgated?"));
  }
}

class UnixListenerTest : public ::testing::Test {
 protected:
  std::string refusal() const {
    const Result<UnixListener> refused = UnixListener::open(path_);
    return refused ? "" : refused.error().message;
  }

  link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "made/axisgate.sock";
};

TEST_F(UnixListenerTest, TheDirectoryIsThisUsersAndTheSocketEverybodys) {
  const Result<UnixListener> listener = UnixListener::open(path_);
  ASSERT_TRUE(listener) << listener.error().message;
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0666u);
  ASSERT_EQ(::stat((directory_ / "made").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0700u);
}

TEST_F(UnixListenerTest, OneThatIsServedIsRefusedAndOneThatIsStaleSetpointRemoved) {
  {
    const Result<UnixListener> first = UnixListener::open(path_);
    EXPECT_THAT(refusal(), HasSubstr("served by another process"));
    std::filesystem::rename(path_, path_ + ".left");
  }
  std::filesystem::rename(path_ + ".left", path_);
  EXPECT_EQ(refusal(), "");
}

TEST_F(UnixListenerTest, WhatIsNoSocketIsLeftAlone) {
  std::filesystem::create_directory(directory_ / "made");
  std::ofstream(path_) << "precious";
  EXPECT_THAT(refusal(), HasSubstr("is not a socket"));
  EXPECT_EQ(std::filesystem::file_size(path_), 8u);
}

TEST_F(UnixListenerTest, ItsFileGoesWithItUnlessAnotherIsThere) {
  std::optional<Result<UnixListener>> listener(UnixListener::open(path_));
  ASSERT_TRUE(*listener);
  listener.reset();
  EXPECT_FALSE(std::filesystem::exists(path_));

  listener.emplace(UnixListener::open(path_));
  std::filesystem::remove(path_);
  std::ofstream(path_) << "another's";
  listener.reset();
  EXPECT_TRUE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace axisgate::server::endpoints_test
