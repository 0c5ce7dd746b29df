// Seeds with twenty users under leases.
#include "tests/simulation/users.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace axisgate::simulation {
namespace {

constexpr int kUserSeeds = 1000;
constexpr int kUserSeedsACase = 10;

void hold(std::uint64_t seed) {
  static const char* const kProfiles[] = {"quiet", "mild", "rough", "hostile"};
  Users users(seed, *Faults::named(kProfiles[seed % 4]));
  users.act_for(std::chrono::minutes(2));
  ASSERT_TRUE(users.world().violations().empty()) << users.world().violations().front() << "\n"
                                                  << users.world().replay();
}

class UserSeeds : public testing::TestWithParam<int> {};

TEST_P(UserSeeds, NobodyMovesWhatAnotherOwns) {
  if (const char* only = std::getenv("AXISGATE_SEED")) {
    if (GetParam() == 0) hold(std::strtoull(only, nullptr, 10));
    return;
  }
  const int first = GetParam() * kUserSeedsACase;
  for (int seed = first; seed < first + kUserSeedsACase && !HasFatalFailure(); ++seed) {
    hold(static_cast<std::uint64_t>(seed));
  }
}

INSTANTIATE_TEST_SUITE_P(Ordinary, UserSeeds, testing::Range(0, kUserSeeds / kUserSeedsACase));

// Seeds in which a jog was accelerated too near to its bound, or was stopped too late before it when an answer was
// lost.
class UserSeedsThatOnceFailed : public testing::TestWithParam<int> {};

TEST_P(UserSeedsThatOnceFailed, StayMended) { hold(static_cast<std::uint64_t>(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Seeds, UserSeedsThatOnceFailed, testing::Values(3733, 4414, 9798, 10559));

// Ensures that the seeds above test something: every event that a lease can have occurs.
TEST(UserSeedsShow, EverythingHappens) {
  Users::Counts sum;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Users users(seed, Faults::none());
    users.act_for(std::chrono::minutes(2));
    const Users::Counts& counts = users.counts();
    sum.granted += counts.granted;
    sum.refused += counts.refused;
    sum.expired += counts.expired;
    sum.taken_over += counts.taken_over;
    sum.handed_over += counts.handed_over;
    sum.latched += counts.latched;
    sum.moved += counts.moved;
    sum.jogged += counts.jogged;
    sum.executed += counts.executed;
  }
  const int counts[] = {sum.granted, sum.refused, sum.expired, sum.taken_over, sum.handed_over,
                        sum.latched, sum.moved,   sum.jogged,  sum.executed};
  EXPECT_THAT(counts, testing::Each(testing::Gt(0)));
}

}  // namespace
}  // namespace axisgate::simulation
