// Limits on what each identity may have open.
#include "server/access/identity_limits.h"

#include <gmock/gmock.h>

#include <optional>
#include <thread>
#include <vector>

namespace axisgate::server::identity_limits_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Kind = IdentityLimits::Kind;

TEST(IdentityLimits, WhoHasAsManyAsOneMayIsToldWhatToDo) {
  IdentityLimits limits({.streams = 2, .calls = 1});
  const auto first = limits.take("unix alice", Kind::stream);
  EXPECT_TRUE(limits.check("unix alice", Kind::stream));
  const auto second = limits.take("unix alice", Kind::stream);
  const auto refused = limits.check("unix alice", Kind::stream);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::queue_full);
  EXPECT_EQ(refused.error().message, "unix alice has 2 streams open, as many as one caller may have");
  EXPECT_THAT(refused.error().hint, StartsWith("close some that nobody reads, and try again in 1 s"));
  EXPECT_THAT(refused.error().hint, HasSubstr("`streams` in [limits]"));
}

TEST(IdentityLimits, StreamsAndCallsCountApart) {
  IdentityLimits limits({.streams = 1, .calls = 1});
  const auto stream = limits.take("unix alice", Kind::stream);
  EXPECT_TRUE(limits.check("unix alice", Kind::call));
  const auto call = limits.take("unix alice", Kind::call);
  const auto refused = limits.check("unix alice", Kind::call);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "unix alice has 1 requests in flight, as many as one caller may have");
  EXPECT_THAT(refused.error().hint, HasSubstr("try again in 1 s; or have `calls` in [limits]"));
}

TEST(IdentityLimits, AnotherIsNotRefused) {
  IdentityLimits limits({.streams = 1, .calls = 1});
  const auto stream = limits.take("unix alice", Kind::stream);
  const auto call = limits.take("unix alice", Kind::call);
  EXPECT_TRUE(limits.check("token night-scan", Kind::stream));
  EXPECT_TRUE(limits.check("token night-scan", Kind::call));
}

TEST(IdentityLimits, APlaceIsFreeWhenTheLastWhoHoldsItHasGone) {
  IdentityLimits limits({.streams = 1, .calls = 1});
  std::optional<IdentityLimits::Place> place = limits.take("unix alice", Kind::stream);
  std::optional<IdentityLimits::Place> same = place;
  place.reset();
  EXPECT_FALSE(limits.check("unix alice", Kind::stream));
  same.reset();
  EXPECT_TRUE(limits.check("unix alice", Kind::stream));
}

TEST(IdentityLimits, OneTooManyIsCountedAllTheSame) {
  IdentityLimits limits({.streams = 1, .calls = 1});
  const auto first = limits.take("unix alice", Kind::call);
  std::optional<IdentityLimits::Place> second = limits.take("unix alice", Kind::call);
  second.reset();
  EXPECT_FALSE(limits.check("unix alice", Kind::call));
}

TEST(IdentityLimits, WhoHasNothingOpenIsForgotten) {
  IdentityLimits limits({});
  std::vector<IdentityLimits::Place> places;
  for (int i = 0; i < 1000; ++i) places.push_back(limits.take("token " + std::to_string(i), Kind::call));
  places.push_back(limits.take("token 7", Kind::stream));
  EXPECT_EQ(limits.identities(), 1000u);
  places.erase(places.begin(), places.begin() + 1000);
  EXPECT_EQ(limits.identities(), 1u);
  places.clear();
  EXPECT_EQ(limits.identities(), 0u);
}

TEST(IdentityLimits, ManyThreadsLoseNoPlace) {
  IdentityLimits limits({.streams = 2, .calls = 2});
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&limits, i] {
      for (int round = 0; round < 2000; ++round) {
        const auto place =
            limits.take(round % 2 == 0 ? "unix alice" : "unix bert", i % 2 == 0 ? Kind::call : Kind::stream);
        (void)limits.check("unix alice", Kind::call);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(limits.identities(), 0u);
}

}  // namespace
}  // namespace axisgate::server::identity_limits_test
