// Seeds of a mill and its controller on a line that loses, doubles and flips bytes, is stuck, loses an XON, and breaks.
//
// Requirements of every run: up to the first changed byte the mill executes the beginning of the job, and all of it if
// the job is FED. After an abort, and after a loss of the line, nothing of the job is written, and the abort is written
// first. The confirmed job is the one that starts. tests/README.md explains more.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>

#include "tests/rml1/bad_line.h"

namespace axisgate::rml1::line_faults_test {
namespace {

constexpr int kSeeds = 500, kSeedsACase = 50;

int seeds() {
  const char* limit = std::getenv("AXISGATE_SEEDS");
  return limit != nullptr ? std::atoi(limit) : kSeeds;
}

LineFaultRun hold(std::uint64_t seed) {
  const LineFaultRun run = BadLine(seed).run();
  EXPECT_FALSE(run.violation) << *run.violation << "\n" << run.replay;
  return run;
}

class MillSeeds : public testing::TestWithParam<int> {};

TEST_P(MillSeeds, TheMillExecutesTheJobAndNothingElse) {
  if (const char* only = std::getenv("AXISGATE_SEED")) {
    if (GetParam() == 0) hold(std::strtoull(only, nullptr, 10));
    return;
  }
  const int first = GetParam() * kSeedsACase;
  for (int seed = first; seed < std::min(first + kSeedsACase, seeds()) && !HasFailure(); ++seed) {
    hold(static_cast<std::uint64_t>(seed));
  }
}

// Runs more seeds than the ordinary run: set AXISGATE_SEEDS=20000 and run this test alone.
TEST(MoreMillSeeds, Hold) {
  for (int seed = kSeeds; seed < seeds() && !HasFailure(); ++seed) hold(static_cast<std::uint64_t>(seed));
}

INSTANTIATE_TEST_SUITE_P(Ordinary, MillSeeds, testing::Range(0, kSeeds / kSeedsACase));

// Checks that the seeds end in different outcomes, and that each fault occurs.
TEST(MillSeedsAll, EachOutcomeAndEachFaultOccurs) {
  std::map<jobs::JobState, int> outcomes;
  int changed = 0, stuck = 0, xon_lost = 0, broke = 0, busy = 0;
  std::size_t ran_on = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const LineFaultRun run = BadLine(seed).run();
    ++outcomes[run.outcome];
    changed += run.byte_changed ? 1 : 0;
    stuck += run.stuck ? 1 : 0;
    xon_lost += run.xon_lost ? 1 : 0;
    broke += run.line_broke ? 1 : 0;
    busy += run.was_busy ? 1 : 0;
    ran_on = std::max(ran_on, run.ran_on);
  }
  std::cout << fmt::format(
      "FED {}, ABORTED {}, PAUSED_UNKNOWN {}; bytes changed {}, CTS stuck {}, XON lost {}, line broken {}, busy {}; "
      "ran on {}\n",
      outcomes[jobs::JobState::fed], outcomes[jobs::JobState::aborted], outcomes[jobs::JobState::paused_unknown],
      changed, stuck, xon_lost, broke, busy, ran_on);
  EXPECT_GE(outcomes[jobs::JobState::fed], 20);
  EXPECT_GE(outcomes[jobs::JobState::aborted], 20);
  EXPECT_GE(outcomes[jobs::JobState::paused_unknown], 10);
  for (const int count : {changed, stuck, xon_lost, broke, busy}) EXPECT_GE(count, 3);
}

}  // namespace
}  // namespace axisgate::rml1::line_faults_test
