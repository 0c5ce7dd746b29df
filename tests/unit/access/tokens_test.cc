// Tokens: made once, stored as hashes, expired, revoked.
#include "server/access/tokens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace axisgate::server::tokens_test {
namespace {

using std::chrono::days;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

constexpr Calendar kNow{seconds(1'800'000'000)};

class TokensTest : public testing::Test {
 protected:
  TokensTest() : path_(testing::TempDir() + "axisgate-tokens-" + std::to_string(::getpid())) { open(); }
  ~TokensTest() override { ::unlink(path_.c_str()); }

  void open() {
    auto opened = Tokens::open(path_);
    ASSERT_TRUE(opened) << opened.error().message;
    tokens_ = *std::move(opened);
  }
  std::string make(const std::string& name, Role role = Role::operator_) {
    const auto made = tokens_->create(name, role, kNow + days(90), kNow);
    EXPECT_TRUE(made) << made.error().message;
    return made.value_or("");
  }
  Reason refused(const Result<std::string>& made) { return made ? Reason::unspecified : made.error().reason; }
  std::string why(const std::string& token, Calendar now = kNow) {
    const auto checked = tokens_->check(token, now);
    return checked ? "good" : std::string(name(checked.error().reason)) + ": " + checked.error().message;
  }
  std::string file() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }

  std::string path_;
  std::unique_ptr<Tokens> tokens_;
};

TEST_F(TokensTest, AreGoodUntilTheyExpire) {
  const std::string token = make("scan", Role::observer);
  EXPECT_EQ(tokens_->check(token, kNow)->role, Role::observer);
  EXPECT_EQ(tokens_->check(token, kNow)->name, "scan");
  EXPECT_EQ(why(token, kNow + days(90) - seconds(1)), "good");
  EXPECT_EQ(why(token, kNow + days(90)), "UNAUTHENTICATED: the token \"scan\" has expired");
}

TEST_F(TokensTest, AreRevokedAtOnce) {
  const std::string token = make("scan");
  ASSERT_TRUE(tokens_->revoke("scan", kNow));
  EXPECT_EQ(why(token), "UNAUTHENTICATED: the token \"scan\" was revoked");
  EXPECT_EQ(tokens_->revoke("scan", kNow).error().reason, Reason::not_found);
  const std::string next = make("scan");
  EXPECT_NE(next, token);
  EXPECT_EQ(why(next), "good");
  EXPECT_THAT(why(token), HasSubstr("revoked"));
}

TEST_F(TokensTest, ABitMoreOrLessIsNone) {
  const std::string token = make("scan");
  EXPECT_GE(token.size() - std::string("axisgate.scan.").size(), 32u) << "hexadecimal digits for 128 bits";
  for (const std::string& wrong : {token + "0", token.substr(1), token.substr(0, token.size() - 1), std::string()}) {
    EXPECT_THAT(why(wrong), HasSubstr("UNAUTHENTICATED")) << wrong;
  }
}

TEST_F(TokensTest, OutliveTheDaemonAsHashes) {
  const std::string token = make("scan"), gone = make("gone");
  ASSERT_TRUE(tokens_->revoke("gone", kNow));
  open();
  EXPECT_EQ(why(token), "good");
  EXPECT_THAT(why(gone), HasSubstr("revoked"));
  const std::string secret = token.substr(token.rfind('.') + 1);
  EXPECT_THAT(file(), Not(HasSubstr(secret)));
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST_F(TokensTest, NamesAndLives) {
  make("scan");
  EXPECT_EQ(refused(tokens_->create("scan", Role::admin, kNow + days(1), kNow)), Reason::invalid_request);
  for (const char* name : {"", "1scan", "a b", "a.b", "a\n", "überall", "a123456789012345678901234567890123"}) {
    EXPECT_EQ(refused(tokens_->create(name, Role::admin, kNow + days(1), kNow)), Reason::invalid_request) << name;
  }
  EXPECT_EQ(refused(tokens_->create("other", Role::admin, kNow, kNow)), Reason::out_of_range);
  EXPECT_EQ(refused(tokens_->create("other", Role::admin, kNow + days(3700), kNow)), Reason::out_of_range);
}

TEST_F(TokensTest, TheOldAreForgotten) {
  make("scan");
  make("other");
  ASSERT_TRUE(tokens_->revoke("scan", kNow));
  const Calendar later = kNow + days(31);
  ASSERT_TRUE(tokens_->create("third", Role::observer, later + days(1), later));
  ASSERT_EQ(tokens_->list().size(), 2u);
  EXPECT_EQ(tokens_->list()[0].name, "other");
}

TEST_F(TokensTest, ALineThatIsNoneIsNamed) {
  make("scan");
  std::ofstream(path_, std::ios::app) << "scan operator 1 2\n";
  const auto opened = Tokens::open(path_);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message, path_ + ":3: is no token");
}

TEST_F(TokensTest, NothingIsMadeThatCannotBeKept) {
  auto nowhere = Tokens::open("/proc/axisgate/tokens");
  ASSERT_TRUE(nowhere);
  EXPECT_EQ((*nowhere)->create("scan", Role::observer, kNow + days(1), kNow).error().reason, Reason::internal);
  EXPECT_TRUE((*nowhere)->list().empty());
}

TEST_F(TokensTest, ARevocationThatCouldNotBeWrittenHoldsAndIsWrittenLater) {
  const std::string token = make("scan");
  EXPECT_EQ(tokens_->write_again(), false);
  // Even root cannot write the file now.
  const std::string obstacle = path_ + ".new";
  ASSERT_EQ(::mkdir(obstacle.c_str(), 0700), 0);
  EXPECT_EQ(tokens_->revoke("scan", kNow).error().reason, Reason::internal);
  EXPECT_THAT(why(token), HasSubstr("revoked"));
  EXPECT_FALSE(tokens_->write_again());
  ASSERT_EQ(::rmdir(obstacle.c_str()), 0);
  EXPECT_EQ(tokens_->write_again(), true);
  EXPECT_EQ(tokens_->write_again(), false);
  open();
  EXPECT_THAT(why(token), HasSubstr("revoked"));
}

TEST(TokenNames, StandInTheToken) {
  EXPECT_EQ(name_in("axisgate.scan.00ff"), "scan");
  EXPECT_EQ(name_in("axisgate.a b.00ff"), "");
  EXPECT_EQ(name_in("scan"), "");
}

}  // namespace
}  // namespace axisgate::server::tokens_test
