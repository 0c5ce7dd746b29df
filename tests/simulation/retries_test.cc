// Seeds with twenty users who repeat their requests, and a daemon that is killed.
#include "tests/simulation/retries.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "tests/simulation/seed_count.h"

namespace axisgate::simulation {
namespace {

constexpr int kRetrySeeds = 1000;
constexpr int kRetrySeedsACase = 10;
constexpr Duration kActing = std::chrono::seconds(20);

RetryTerms terms_of(std::uint64_t seed) {
  static const char* const kProfiles[] = {"quiet", "mild", "rough", "hostile"};
  return {.faults = *Faults::named(kProfiles[seed % 4])};
}

void hold(std::uint64_t seed) {
  Retries retries(seed, terms_of(seed));
  retries.act_for(kActing);
  retries.become_stationary();
  ASSERT_TRUE(retries.world().violations().empty()) << retries.world().violations().front() << "\n"
                                                    << retries.world().replay();
}

class RetrySeeds : public testing::TestWithParam<int> {};

TEST_P(RetrySeeds, NothingMovesTwice) {
  if (const char* only = std::getenv("AXISGATE_SEED")) {
    if (GetParam() == 0) hold(std::strtoull(only, nullptr, 10));
    return;
  }
  const int first = GetParam() * kRetrySeedsACase;
  for (int seed = first; seed < std::min(first + kRetrySeedsACase, seed_count(kRetrySeeds)) && !HasFatalFailure();
       ++seed) {
    hold(static_cast<std::uint64_t>(seed));
  }
}

INSTANTIATE_TEST_SUITE_P(Ordinary, RetrySeeds, testing::Range(0, seed_cases(kRetrySeeds, kRetrySeedsACase)));

// Ensures that the seeds above test something: every event that a request can have occurs.
TEST(RetrySeedsShow, EverythingHappens) {
  Retries::Counts sum;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Retries retries(seed, terms_of(seed));
    retries.act_for(kActing);
    retries.become_stationary();
    const Retries::Counts& counts = retries.counts();
    sum.requested += counts.requested;
    sum.repeated += counts.repeated;
    sum.reordered += counts.reordered;
    sum.reused += counts.reused;
    sum.duplicated += counts.duplicated;
    sum.stale += counts.stale;
    sum.late += counts.late;
    sum.succeeded += counts.succeeded;
    sum.executed += counts.executed;
    sum.kills += counts.kills;
    sum.kills_in_motion += counts.kills_in_motion;
    sum.hangs += counts.hangs;
    sum.refused_by_disk += counts.refused_by_disk;
    sum.never_sent += counts.never_sent;
    sum.unknown += counts.unknown;
  }
  const int counts[] = {sum.requested,  sum.repeated,        sum.reordered, sum.reused,
                        sum.duplicated, sum.stale,           sum.late,      sum.succeeded,
                        sum.executed,   sum.kills,           sum.hangs,     sum.kills_in_motion,
                        sum.never_sent, sum.refused_by_disk, sum.unknown};
  EXPECT_THAT(counts, testing::Each(testing::Gt(10)));
}

// With a memory of a single request, and users who do not send the mark of the memory, requests act twice, and the
// checks detect it.
TEST(RetrySeedsShow, WhatAForgetfulMemoryDoesTwice) {
  int acted_again = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Retries retries(seed, {.faults = Faults::none(), .bounds = {.most = 1}, .marks = false, .kills = false});
    retries.act_for(kActing);
    ASSERT_FALSE(retries.world().violations().empty()) << "seed " << seed;
    acted_again += retries.world().violations().front().find("acts again") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(acted_again, 5);
}

}  // namespace
}  // namespace axisgate::simulation
