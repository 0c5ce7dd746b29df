// Tokens of leases, and their seals.
#include "server/access/lease_tokens.h"

#include <gtest/gtest.h>

namespace axisgate::server::lease_tokens_test {
namespace {

// A token with one changed bit is a guess.
TEST(LeaseTokensTest, OnlyWhatWasSealedIsOpened) {
  const LeaseTokens tokens(7);
  const std::string sealed = tokens.seal(0x0102030405060708);
  EXPECT_EQ(sealed.substr(0, 8), "\x01\x02\x03\x04\x05\x06\x07\x08");
  EXPECT_EQ(sealed.size(), 24u);
  EXPECT_EQ(tokens.open(sealed), 0x0102030405060708u);
  EXPECT_EQ(tokens.open(""), 0u);
  for (std::size_t bit = 0; bit < 8 * sealed.size(); ++bit) {
    std::string guess = sealed;
    guess[bit / 8] = static_cast<char>(guess[bit / 8] ^ (1 << bit % 8));
    EXPECT_EQ(tokens.open(guess).error().reason, Reason::lease_lost) << bit;
  }
  for (const std::string& wrong : {sealed.substr(1), sealed + "x", std::string("7")}) {
    EXPECT_EQ(tokens.open(wrong).error().message, "what was given is no lease token");
  }
}

TEST(LeaseTokensTest, ATokenOfAnEarlierRunIsNoMore) {
  LeaseTokens before(7), same(7);
  const LeaseTokens after(8);
  const std::string sealed = before.seal(before.next());
  EXPECT_EQ(after.open(sealed).error().message,
            "no lease has this token; those of before the daemon's start have ended");
  EXPECT_EQ(same.open(sealed).error().message, kNoSuchLease) << "two runs share no key";
}

}  // namespace
}  // namespace axisgate::server::lease_tokens_test
