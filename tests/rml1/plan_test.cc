// Tests of the figures computed before a job is sent: its window, and the duration of commands that run on after an
// abort.
#include "device/rml1/sending/plan.h"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>

#include "tests/rml1/mill.h"

namespace axisgate::rml1::plan_test {
namespace {

// Bytes for which a mill has no room are lost if flow control does not stop its host.
TEST(Plan, AnAdaptedWindowFitsTheBuffer) {
  std::string job = "^PA;V15;VS15;";
  for (int i = 0; i < 400; ++i) job += i % 21 == 0 ? "PU4000,0000;PU0,0;" : "PU0008,0000;";
  Profile profile = test_profile();
  profile.acceleration = {.best = 1e7, .worst = 1e7, .slower = 0};
  const Timeline timeline(job, profile, std::nullopt);
  EXPECT_GT(plan_of(job, timeline, {.slack = 1, .buffer = 1024}).window, 100u);
  EXPECT_EQ(plan_of(job, timeline, {.slack = 1, .buffer = 100}).window, 100u);
}

// Returns the longest duration after an abort, less the time of 64 bytes on the line, ten bits each. The mill needs no
// time to accelerate.
double longest_s(const std::string& job, double slack = 1) {
  Profile profile = test_profile();
  profile.acceleration = {.best = 1e7, .worst = 1e7, .slower = 0};
  const SendPlan plan = plan_of(job, Timeline(job, profile, std::nullopt), {.window = 64, .slack = slack});
  return std::chrono::duration<double>(plan.run_on.longest).count() - 640 / 9600.0;
}

// 10 mm at 15 mm/s each, by commands of nine and six bytes in turn: nine of them end within 64 bytes.
TEST(Plan, TheTimeOfWhatRunsOn) {
  std::string job = "!MC0;^PA;V15;VS15;";
  for (int i = 0; i < 100; ++i) job += "PU1000,0;PU0,0;";
  EXPECT_NEAR(longest_s(job), 9 * 10 / 15.0, 0.001);
  EXPECT_NEAR(longest_s(job, 1.5), 1.5 * 9 * 10 / 15.0, 0.001);
}

TEST(Plan, TheTimeIsThatOfTheSlowestPlace) {
  std::string fast;
  for (int i = 0; i < 50; ++i) fast += "VS15;";
  EXPECT_NEAR(longest_s("!MC0;^PA;" + fast + "PU3000,0;" + fast + "PU0,0;PU3000,0;" + fast), 2 * 30 / 15.0, 0.001);
}

TEST(Plan, TheTimeOfAShortJobIsThatOfAllOfIt) {
  EXPECT_NEAR(longest_s("!MC0;^PA;V15;VS15;PU3000,0;PU0,0;"), 2 * 30 / 15.0, 0.001);
}

}  // namespace
}  // namespace axisgate::rml1::plan_test
