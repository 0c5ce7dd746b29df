// Token buckets, and the data kept about each source.
#include <gtest/gtest.h>

#include <chrono>

#include "server/front/budget.h"

namespace axisgate::front::budget_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr TimePoint kBegin{seconds(100)};

TEST(TokenBucket, WhatIsNotThereIsDebt) {
  TokenBucket bucket({10, 5}, kBegin);
  bucket.take(5, kBegin);
  EXPECT_EQ(bucket.debt(), Duration::zero());
  bucket.take(2, kBegin);
  EXPECT_EQ(bucket.debt(), milliseconds(200));
  bucket.take(0, kBegin + milliseconds(150));
  EXPECT_EQ(bucket.debt(), milliseconds(50));
}

TEST(TokenBucket, FillsUpToItsBurst) {
  TokenBucket bucket({10, 5}, kBegin);
  bucket.take(5, kBegin);
  EXPECT_FALSE(bucket.full(kBegin + milliseconds(499)));
  EXPECT_TRUE(bucket.full(kBegin + milliseconds(500)));
  bucket.take(6, kBegin + seconds(1000));
  EXPECT_EQ(bucket.debt(), milliseconds(100));
}

TEST(TokenBucket, TakesNothingThatIsNotThere) {
  TokenBucket bucket({10, 1}, kBegin);
  EXPECT_TRUE(bucket.take_if_there(1, kBegin));
  EXPECT_FALSE(bucket.take_if_there(1, kBegin + milliseconds(99)));
  EXPECT_TRUE(bucket.take_if_there(1, kBegin + milliseconds(100)));
  EXPECT_EQ(bucket.debt(), Duration::zero());
}

TEST(TokenBucket, ATimeThatWentBackFillsNothing) {
  TokenBucket bucket({10, 1}, kBegin);
  bucket.take(1, kBegin);
  EXPECT_FALSE(bucket.take_if_there(1, kBegin - seconds(5)));
  EXPECT_FALSE(bucket.take_if_there(1, kBegin));
}

TEST(Sources, ShareABudgetAndAreForgottenWhenTheyAreIdle) {
  constexpr Rate kRate{10, 10};
  Sources sources({{{kRate, kRate, kRate, kRate, kRate, kRate}}, kRate, kRate});
  auto anna = sources.of("uid 1", kBegin);
  EXPECT_EQ(sources.of("uid 1", kBegin), anna);
  EXPECT_NE(sources.of("uid 2", kBegin), anna);
  sources.forget_idle(kBegin);
  EXPECT_EQ(sources.size(), 1u);
  EXPECT_TRUE(anna->handshakes.take_if_there(10, kBegin));
  anna.reset();
  sources.forget_idle(kBegin + milliseconds(999));
  EXPECT_EQ(sources.size(), 1u);
  sources.forget_idle(kBegin + seconds(1));
  EXPECT_EQ(sources.size(), 0u);
}

}  // namespace
}  // namespace axisgate::front::budget_test
