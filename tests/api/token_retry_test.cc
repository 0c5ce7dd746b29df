// Tests of a revocation that could not be written: it is effective at once, and is retried until it is on disk.
#include "server/api/sharing/token_retry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <deque>
#include <filesystem>

#include "tests/api/log.h"
#include "tests/api/world.h"

namespace axisgate::api {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kOnDisk = "the revocations of tokens that could not be written are on disk now\n";

class TokenRetryTest : public ::testing::Test {
 protected:
  TokenRetryTest() { fs::create_directories(folder_); }
  ~TokenRetryTest() override { fs::remove_all(folder_); }

  // Makes writing fail, also for root, who ignores file modes.
  void break_disk() { fs::create_directory(folder_ + "/tokens.new"); }
  void repair_disk() { fs::remove(folder_ + "/tokens.new"); }

  std::string make(const std::string& name) {
    return tokens_->create(name, server::Role::observer, now_ + std::chrono::hours(1), now_).value_or("");
  }
  // Reports whether the token would be revoked after a restart of the daemon.
  bool revoked_on_disk(const std::string& token) {
    return !(*server::Tokens::open(folder_ + "/tokens"))->check(token, now_);
  }
  void revoke(const std::string& name) {
    const Result<void> revoked = tokens_->revoke(name, now_);
    ASSERT_FALSE(revoked);
    retry_->start(revoked.error());
  }
  void run_next() {
    const auto task = std::move(tasks_.front());
    tasks_.pop_front();
    task();
  }

  const std::string folder_ = ::testing::TempDir() + "axisgate-token-retry-" + std::to_string(::getpid());
  const server::Calendar now_ = server::calendar_now();
  std::unique_ptr<server::Tokens> tokens_ = *server::Tokens::open(folder_ + "/tokens");
  std::deque<std::function<void()>> tasks_;
  std::shared_ptr<TokenRetry> retry_ = TokenRetry::make(*tokens_, [this](Duration wait, std::function<void()> task) {
    EXPECT_EQ(wait, server::kTokenRetryPause);
    tasks_.push_back(std::move(task));
  });
};

TEST_F(TokenRetryTest, TriesUntilItIsOnDiskAndSaysSoOnce) {
  const std::string scan = make("scan"), other = make("other");
  break_disk();
  Log log;
  revoke("scan");
  revoke("other");
  EXPECT_EQ(tasks_.size(), 1u) << "one try writes all of them";
  EXPECT_THAT(log.text(), HasSubstr("tokens.new"));
  EXPECT_THAT(log.text(), HasSubstr("the revocation holds, and writing it is tried again every 2 s\n"));
  const std::string before = log.text();
  for (int i = 0; i < 3; ++i) {
    run_next();
    ASSERT_EQ(tasks_.size(), 1u);
  }
  EXPECT_FALSE(revoked_on_disk(scan));
  repair_disk();
  run_next();
  EXPECT_TRUE(revoked_on_disk(scan));
  EXPECT_TRUE(revoked_on_disk(other));
  EXPECT_TRUE(tasks_.empty());
  EXPECT_EQ(log.text(), before + kOnDisk);
}

TEST_F(TokenRetryTest, SaysSoAlsoWhenANewTokenWasWrittenWithIt) {
  make("scan");
  break_disk();
  Log log;
  revoke("scan");
  repair_disk();
  ASSERT_NE(make("next"), "");
  const std::string before = log.text();
  run_next();
  EXPECT_EQ(log.text(), before + kOnDisk);
  EXPECT_TRUE(tasks_.empty());
}

TEST_F(TokenRetryTest, BeginsAgainWithTheNextRevocation) {
  make("scan");
  const std::string other = make("other");
  break_disk();
  Log log;
  revoke("scan");
  repair_disk();
  run_next();
  break_disk();
  revoke("other");
  repair_disk();
  ASSERT_EQ(tasks_.size(), 1u);
  run_next();
  EXPECT_TRUE(revoked_on_disk(other));
}

TEST_F(TokenRetryTest, OutlivesThoseWhoStartedIt) {
  const std::string scan = make("scan");
  break_disk();
  Log log;
  revoke("scan");
  retry_.reset();
  repair_disk();
  run_next();
  EXPECT_TRUE(revoked_on_disk(scan));
}

TEST(TokensOfApi, ARevocationThatCannotBeWrittenHoldsAndTheAnswerSaysSo) {
  Log log;
  {
    World world;
    const std::string file = world.directory + "/tokens", token = world.token("scan", server::Role::observer);
    const auto refused_by = [&](const server::Tokens& tokens) { return !tokens.check(token, server::calendar_now()); };
    fs::create_directory(file + ".new");
    const Result<void> revoked = world.api->tokens.revoke(World::by(kAdmin), "scan");
    fs::remove(file + ".new");
    EXPECT_TRUE(refused_by(world.access->tokens()));
    ASSERT_FALSE(revoked);
    EXPECT_EQ(revoked.error().reason, Reason::internal);
    EXPECT_EQ(revoked.error().message,
              "the token scan is revoked, but not on disk, so a restart would make it valid again: cannot write " +
                  file + ".new: File exists");
    EXPECT_EQ(revoked.error().hint,
              "let the daemon's user write there; the daemon tries again every few seconds, and its log says when it "
              "succeeded");
    EXPECT_TRUE(comes_true([&] { return refused_by(**server::Tokens::open(file)); }));
  }
  EXPECT_THAT(log.text(), AllOf(HasSubstr("unix root revoked the token scan\n"), HasSubstr(kOnDisk)));
}

}  // namespace
}  // namespace axisgate::api
