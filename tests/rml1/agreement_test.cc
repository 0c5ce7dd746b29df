// Comparison of the gateway's model with the simulated mill on the same jobs: the same moves and waits, the same final
// place, the same duration. The two share no parser and no machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "device/rml1/check/check.h"
#include "device/rml1/machine/profile_files.h"
#include "device/rml1/sending/timeline.h"
#include "tests/paths/paths.h"
#include "tests/rml1/courses.h"
#include "tests/rml1/mill.h"
#include "tests/rml1/paragraphs.h"
#include "tests/rml1/random_jobs.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1::agreement_test {
namespace {

constexpr unsigned kSeeds = 1000;
constexpr double kPart = 0.001;    // permitted relative difference of two durations
constexpr double kInstant = 0.01;  // seconds; permitted difference for a job that takes no time

struct Job {
  std::string name, text;
};

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Ends the job with a delimiter and removes !NR: the length of its pause, and the spindle meanwhile, depend on a person
// (guideline 3-3 !NR).
Job whole(const std::string& name, std::string text) {
  for (auto at = text.find("!NR"); at != std::string::npos; at = text.find("!NR")) text.replace(at, 3, ";");
  return {name, text + ";"};
}

std::vector<Job> files() {
  std::vector<Job> jobs;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(paths::in_project("tests"))) {
    const std::string ending = entry.path().extension();
    if (ending == ".rml" || ending == ".prn") jobs.push_back(whole(entry.path().filename(), contents(entry.path())));
  }
  return jobs;
}

// Returns the guideline's examples and its cases of clipping. Leaves out examples for a parser with an additional row,
// and examples with half a step, which may be rounded up or down.
std::vector<Job> typed() {
  std::vector<Job> jobs;
  for (const Paragraph& example : paragraphs("examples")) {
    const bool half = example.all("<").at(0).find(".5") != std::string::npos;
    if (!half && example.all("%").empty()) jobs.push_back(whole(example.where, unescaped(example.all("<").at(0))));
  }
  for (const Paragraph& geometry : paragraphs("clipping")) {
    std::string text;
    for (const std::string& line : geometry.all("job")) text += line;
    jobs.push_back(whole(geometry.where, text));
  }
  return jobs;
}

std::vector<Job> random_jobs() {
  std::vector<Job> jobs;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937 random(seed);
    jobs.push_back(whole(fmt::format("seed {}", seed), random_job(random)));
  }
  return jobs;
}

std::vector<Job> all_jobs() {
  std::vector<Job> jobs = random_jobs();
  for (const Job& job : files()) jobs.push_back(job);
  for (const Job& job : typed()) jobs.push_back(job);
  return jobs;
}

std::vector<Profile> profiles() {
  std::vector<Profile> all = {test_profile()};
  for (const auto& file : shipped_profiles()) all.push_back(load_profile(file).value());
  return all;
}

simulator::MillSetup setup(const Profile& profile, std::string_view acceleration = "none", double slower_percent = 0) {
  simulator::MillSetup made;
  made.profile = profile;
  made.slower_percent = slower_percent;
  // ESC.K among the bytes ends the movement in progress, and the following bytes are executed, as in a check of a job.
  return simulator::with_options({{"acceleration", acceleration}, {"escape_k", "one-shot"}}, made);
}

void expect_close(double mill, double model, const Job& job) {
  EXPECT_NEAR(mill, model, model * kPart + kInstant) << job.name << ": " << job.text;
}

// Expects equal durations. With dwells, the longest time may be greater: the mill dwells only once for each command.
void expect_time(double mill, double longest, const Job& job) {
  if (job.text.find('W') == std::string::npos) return expect_close(mill, longest, job);
  EXPECT_LE(mill, longest * (1 + kPart) + kInstant) << job.name << ": " << job.text;
}

// Returns the longest time that `axisctl mill check` prints, for a machine that needs no time to accelerate.
double seconds_of_check(const Job& job, Profile profile) {
  profile.acceleration = {.best = 1e9, .worst = 1e9, .slower = 0};
  Check check(profile, {.origin = kWork, .stock = {}, .others = {}});
  check.feed(job.text);
  check.finish();
  EXPECT_FALSE(check.is_other_file()) << job.name;
  EXPECT_LE(check.summary().seconds_low, check.summary().seconds_high) << job.name;
  return check.summary().seconds_high;
}

TEST(MillAndModel, HaveJobs) {
  EXPECT_GE(files().size(), 11u);
  EXPECT_GE(typed().size(), 600u);
  EXPECT_GE(profiles().size(), 7u);
}

TEST(MillAndModel, TakeTheSameCourse) {
  const auto mills = profiles();
  for (const Job& job : all_jobs()) {
    for (const Profile& profile : mills) {
      const Course model = course_of_model(job.text, profile), mill = course_of_mill(job.text, setup(profile));
      ASSERT_THAT(mill.events, testing::ContainerEq(model.events))
          << profile.name << ", " << job.name << ": " << job.text;
      ASSERT_EQ(Course::Event{.to = mill.final}, Course::Event{.to = model.final}) << profile.name << ", " << job.name;
    }
  }
}

TEST(MillAndModel, TakeTheSameTimeWithoutAcceleration) {
  const auto mills = profiles();
  for (const Job& job : all_jobs()) {
    for (Profile profile : mills) {
      profile.baud.reset();
      expect_time(course_of_mill(job.text, setup(profile)).seconds, seconds_of_check(job, profile), job);
    }
  }
}

TEST(MillAndModel, TakeTheSameTimeOnALine) {
  Profile profile = test_profile();
  profile.baud = 1200;
  for (const Job& job : random_jobs()) {
    expect_time(course_of_mill(job.text, setup(profile), 1200).seconds, seconds_of_check(job, profile), job);
  }
}

// A sender's progress and window are based on this range. Its low end is distance over speed; at its high end every
// move begins and ends with the tool stationary, as slow as the profile allows.
TEST(MillAndModel, TheTimeIsWithinTheRange) {
  const auto mills = profiles();
  for (const Job& job : all_jobs()) {
    for (const Profile& profile : mills) {
      const Timeline range(job.text, profile, kWork);
      const double slower = profile.acceleration.slower * 100;
      const double fastest = course_of_mill(job.text, setup(profile)).seconds;
      const double best = course_of_mill(job.text, setup(profile, "best")).seconds;
      const double slowest = course_of_mill(job.text, setup(profile, "worst", slower)).seconds;
      for (const double seconds : {fastest, best, slowest}) {
        EXPECT_GE(seconds, sum_of(range, &Step::least_s) * (1 - kPart) - kInstant)
            << profile.name << ", " << job.name << ": " << job.text;
        EXPECT_LE(seconds, range.slowest_s() * (1 + kPart) + kInstant)
            << profile.name << ", " << job.name << ": " << job.text;
      }
      expect_time(slowest, range.slowest_s(), job);
    }
  }
}

}  // namespace
}  // namespace axisgate::rml1::agreement_test
