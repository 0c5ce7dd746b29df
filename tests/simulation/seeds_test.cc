// Seeds of random callers on a bad line, each seed with a different combination of interpretations of the manual.
//
// Requirements of every run: no answer is matched to another question. A success is a place where the device truly is.
// No axis is started more often than requested. After a stop only motions that were requested after it start. Every
// motion has an outcome. Once the line works again, the device answers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "tests/simulation/callers.h"
#include "tests/simulation/scenario.h"
#include "tests/simulation/seed_count.h"
#include "tests/simulation/trial.h"

namespace axisgate::simulation {
namespace {

constexpr int kSeeds = 1000;
constexpr int kSeedsACase = 10, kShapedSeedsACase = 3, kStoppedSeedsACase = 3;

void hold(const Trial& trial) {
  const TrialResult result = run(trial);
  ASSERT_FALSE(result.violation) << *result.violation << "\n" << result.replay;
}

class Seeds : public testing::TestWithParam<int> {};

// Runs ten seeds per case, so that a run shows its progress and can be spread over the cores.
TEST_P(Seeds, NothingIsMixedUp) {
  if (const char* only = std::getenv("AXISGATE_SEED")) {
    if (GetParam() == 0) hold({.seed = std::strtoull(only, nullptr, 10)});
    return;
  }
  const int first = GetParam() * kSeedsACase;
  for (int seed = first; seed < std::min(first + kSeedsACase, seed_count(kSeeds)) && !HasFatalFailure(); ++seed) {
    hold({.seed = static_cast<std::uint64_t>(seed)});
  }
}

// Other seeds, in which a caller stops the stage at each fault.
TEST_P(Seeds, NorWithStopsAtEachFault) {
  const auto stopped = [](std::uint64_t seed) { return Trial{.seed = seed, .habits = {.stop_at_faults = true}}; };
  if (const char* only = std::getenv("AXISGATE_SEED")) {
    if (GetParam() == 0) hold(stopped(std::strtoull(only, nullptr, 10)));
    return;
  }
  const auto first = static_cast<std::uint64_t>(8'000'000 + GetParam() * kStoppedSeedsACase);
  for (std::uint64_t seed = first; seed < first + kStoppedSeedsACase && !HasFatalFailure(); ++seed) hold(stopped(seed));
}

// Other seeds, in which callers draw curves, rest between segments, approach targets from one side, and scan.
TEST_P(Seeds, NorWithShapes) {
  const auto shaped = [](std::uint64_t seed) {
    Trial trial{.seed = seed};
    trial.habits.shapes = true;
    return trial;
  };
  if (const char* only = std::getenv("AXISGATE_SEED")) {
    if (GetParam() == 0) hold(shaped(std::strtoull(only, nullptr, 10)));
    return;
  }
  const auto first = static_cast<std::uint64_t>(5'000'000 + GetParam() * kShapedSeedsACase);
  for (std::uint64_t seed = first; seed < first + kShapedSeedsACase && !HasFatalFailure(); ++seed) hold(shaped(seed));
}

// Ensures that requests for shapes are not all refused.
TEST(ShapedCallers, GetThroughOnAGoodLine) {
  World world(drawn_setup(5'000'000, Faults::none()));
  Callers callers(world, 5'000'000, 0, {.shapes = true});
  callers.act_for(std::chrono::minutes(10));
  std::map<stage::MotionKind, int> well;
  for (const auto& motion : world.outcomes()) {
    if (motion.state == stage::MotionState::succeeded) ++well[motion.kind];
  }
  EXPECT_GT(well[stage::MotionKind::scan], 5) << world.replay();
  EXPECT_GT(well[stage::MotionKind::path], 20) << world.replay();
  EXPECT_GT(written(world, "EP:2A"), 20) << world.replay();
  EXPECT_GT(written(world, "EP:1A"), 20) << world.replay();
  EXPECT_TRUE(world.violations().empty()) << world.violations().front();
}

// 10085: a command cut in two by the line is refused twice. 10270: the OK of a stop written inside a barrier was
// received after an identity requested before it. 10875: an outstanding identity was taken for the answer to ?:CMD.
// 31352: one flipped bit changed a B into an R while an axis settled. 40555: the second half of a doubled OK was
// received during a stop.
TEST(SeedsThatOnceFailed, StayMended) {
  for (const std::uint64_t seed : {10085u, 10270u, 10875u, 31352u, 40555u}) {
    Trial trial{.seed = seed, .duration = std::chrono::minutes(3)};
    Faults& faults = trial.faults;  // only the faults that existed then
    faults.mishaps_an_hour = faults.lose_byte = faults.double_byte = faults.eight_bit = faults.merge = 0;
    faults.flip_notice = faults.reorder_notice = 0;
    if (!HasFatalFailure()) hold(trial);
  }
}

// The same with all faults. 402359, 500862: a flood of axis numbers around I:. 402608, 501949, 600006: the second
// refusal of a command cut in two was late. 701287: ZRT: of all axes was received instead of ZRT:1. 805722: two motions
// searched for stale setpoints at once. 194: an axis completed right after the reading that showed it busy again.
// 903823, 1201942: a restart after a late answer. 566: an identity that was answered twice was taken for the identity
// requested after a stop.
TEST(SeedsThatOnceFailed, StayMendedWithAllFaults) {
  for (const std::uint64_t seed :
       {402359u, 500862u, 402608u, 501949u, 600006u, 701287u, 805722u, 903823u, 1201942u, 20000561u, 566u, 194u}) {
    if (!HasFatalFailure()) hold({.seed = seed});
  }
}

// 8100002: a stop was late before it was seen that a prebuffer keeps a segment, and no caller was notified. 8401104:
// the late answer to a ?:CMD from before a stop was taken for the answer to the next ?:CMD.
TEST(SeedsThatOnceFailed, StayMendedWithStopsAtEachFault) {
  for (const std::uint64_t seed : {8100002u, 8401104u}) {
    if (!HasFatalFailure()) hold({.seed = seed, .habits = {.stop_at_faults = true}});
  }
}

INSTANTIATE_TEST_SUITE_P(Ordinary, Seeds, testing::Range(0, seed_cases(kSeeds, kSeedsACase)));

}  // namespace
}  // namespace axisgate::simulation
