// Comparison of the time stated before a job is sent with the time that the simulated mill takes.
#include "device/rml1/sending/job_times.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "device/rml1/machine/profile_files.h"
#include "device/rml1/mill/prepared_job.h"
#include "tests/paths/paths.h"
#include "tests/rml1/fed_mill.h"
#include "tests/rml1/sender_line.h"
#include "tests/rml1/short_vectors.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1::job_times_test {
namespace {

constexpr Duration kForever = std::chrono::hours(100);

double seconds(Duration time) { return std::chrono::duration<double>(time).count(); }

// A mill with flow control, and the streaming that feeds it.
struct Way {
  Profile profile;
  jobs::Streaming streaming = jobs::Streaming::full;
  std::string_view acceleration = "none";
};

// Returns the time from the first byte to the end of the last movement.
double driven_s(const PreparedJob& job, const Way& way) {
  simulator::MillSetup setup = simulator::with_options({{"acceleration", way.acceleration}});
  setup.profile = way.profile;
  setup.flow = simulator::Flow::rts;
  FedMill line(job.text(), setup, job.settings().baud);
  SenderLine beside(way.profile, job.settings(), line);
  Sender sender(job.text(), job.timeline(), way.profile, job.settings(), job.plan(), beside.mill());
  feed_all(sender, line, kForever, [](TimePoint) {});
  return line.seconds();
}

PreparedJob prepared(const std::string& body, const Way& way) {
  return {body, "", way.profile, kAtHome, {.streaming = way.streaming, .flow_control = true}};
}

Way on(std::string_view acceleration, jobs::Streaming streaming = jobs::Streaming::full) {
  return {short_vectors_profile(), streaming, acceleration};
}

void expect_within(const jobs::TimeRange& takes, double driven, const std::string& what) {
  EXPECT_GE(driven, seconds(takes.least) * 0.999 - 0.01) << what;
  EXPECT_LE(driven, seconds(takes.most) + 0.01) << what;
}

// 20 mm at 10 mm/s, on the mill's first level: 2 s at full speed, 3 s if slower by half throughout.
TEST(JobTimes, OfOneMove) {
  const PreparedJob job = prepared("!MC0;^PA;V10;Z2000,0,0;", on("none"));
  EXPECT_NEAR(seconds(job.times().whole().least), 2, 0.1);
  EXPECT_NEAR(seconds(job.times().whole().most), 3, 0.1);
}

// A lift may have no distance if Z0 may be the top. The rest is at least 10 mm across at 10 mm/s.
TEST(JobTimes, WithoutAnOriginWaysAboveTheSurfaceMayBeNone) {
  const std::string body = "!MC0;^PA;V10;!PZ-100,2000;F10;PU0,0;PD0,0;PD1000,0;PU1000,0;";
  const Profile profile = short_vectors_profile();
  const PreparedJob anywhere(body, "", profile, std::nullopt, {.streaming = jobs::Streaming::full});
  const PreparedJob deep(body, "", profile, jobs::Origin{0, 0, 30}, {.streaming = jobs::Streaming::full});
  EXPECT_LT(anywhere.times().whole().least, deep.times().whole().least);
  EXPECT_NEAR(seconds(anywhere.times().whole().least), 1 + 0.2, 0.15) << "and 1 mm down, and up";
}

// A triangular profile takes 2 sqrt(0.2 mm / 100 mm/s2), 89 ms, while 0.2 mm at 10 mm/s takes 20 ms.
TEST(JobTimes, OfAMillThatStopsAtEachPoint) {
  const PreparedJob job = prepared(uniform_vectors(1000), on("none"));
  constexpr double way_s = 14.15;  // to the first point, 100.2 mm and 100 mm away
  EXPECT_NEAR(seconds(job.times().whole().least), way_s + 20, 0.2);
  EXPECT_NEAR(seconds(job.times().whole().most), 1.5 * way_s + 89.4, 0.4);
}

TEST(JobTimes, ContainWhatTheMillTakes) {
  for (const auto& [name, body] : {std::pair{"uniform", uniform_vectors(400)}, {"bursts", bursts_of_vectors(400)}}) {
    for (const jobs::Streaming streaming : {jobs::Streaming::full, jobs::Streaming::paced}) {
      for (const std::string_view acceleration : {"none", "best", "worst"}) {
        const Way way = on(acceleration, streaming);
        const PreparedJob job = prepared(body, way);
        expect_within(job.times().whole(), driven_s(job, way), fmt::format("{} {}", name, acceleration));
      }
    }
  }
}

// The mill receives bytes only as fast as the slowest mill would have room for them.
TEST(JobTimes, OfAPacedJobAreThoseOfItsSending) {
  const PreparedJob job = prepared(uniform_vectors(400), on("none", jobs::Streaming::paced));
  const jobs::TimeRange takes = job.times().whole();
  EXPECT_GT(seconds(takes.least), 0.98 * seconds(takes.most) - 1);
  EXPECT_NEAR(seconds(takes.most), job.timeline().slowest_s() * 1.5, 0.02 * seconds(takes.most));
}

TEST(JobTimes, WhatIsLeftBeginsAtAllAndEndsAtNothing) {
  for (const jobs::Streaming streaming : {jobs::Streaming::full, jobs::Streaming::paced}) {
    const PreparedJob job = prepared(uniform_vectors(100), on("none", streaming));
    const JobTimes& times = job.times();
    EXPECT_EQ(times.left(0, 0), times.whole());
    EXPECT_EQ(times.left(job.text().size(), job.text().size()), jobs::TimeRange());
    const std::size_t half = job.text().size() / 2;
    EXPECT_LT(times.left(half, half).most, times.whole().most);
    EXPECT_GT(times.left(half, half).least, Duration());
    EXPECT_EQ(times.left(0, half).most, times.whole().most);
    EXPECT_EQ(times.left(0, half).least, times.left(half, half).least);
  }
}

// The mill stops its line most of the time, which shows its pace.
TEST(JobTimes, WhatIsLeftFollowsAMillThatShowsItsPace) {
  const Way way = on("none");
  const PreparedJob job = prepared(uniform_vectors(3000), way);
  const jobs::MeasuredPace pace{0.2, 0.22};
  const jobs::SendProgress progress{.executed_least = 1000, .executed_most = 2000};
  const jobs::TimeRange left = left_of(job, progress, pace);
  EXPECT_NEAR(seconds(left.most), job.timeline().slowest_after(1000) * 0.22 * 1.1, 1e-6);
  EXPECT_NEAR(seconds(left.least), job.timeline().slowest_after(2000) * 0.2 / 1.1, 1e-6);
  const jobs::TimeRange full_speed = job.times().left(1000, 1000);
  EXPECT_EQ(left_of(job, {.executed_least = 1000, .executed_most = 1000}, jobs::MeasuredPace{0.01, 0.011}),
            (jobs::TimeRange{full_speed.least, full_speed.least}))
      << "no mill is faster than at full speed";
  EXPECT_EQ(left_of(job, progress, std::nullopt), job.times().left(1000, 2000));
}

// A job of tests/jobs, written like the output of common programs.
struct Written {
  std::string file, mill, kind, body;
};

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Returns 40 jobs, a number of each kind.
std::vector<Written> written_jobs() {
  const std::map<std::string, int> wanted = {{"board", 14}, {"outline", 7},      {"holes", 5},
                                             {"text", 4},   {"relief-rough", 5}, {"relief-fine", 5}};
  std::map<std::string, int> taken;
  std::vector<Written> jobs;
  std::ifstream table(paths::written_jobs() / "jobs.tsv");
  for (std::string line; std::getline(table, line);) {
    std::istringstream cells(line);
    Written job;
    cells >> job.file >> job.mill >> job.kind;
    if (!wanted.contains(job.kind) || taken[job.kind]++ >= wanted.at(job.kind)) continue;
    job.body = text_of(paths::written_jobs() / job.file);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

class TimesOfWrittenJobs : public testing::TestWithParam<const char*> {};

// Stated times of one job, and the mill's times with each acceleration of the simulator.
struct Compared {
  double stated = 0, driven = 0;  // ratio of the longest to the shortest
};

Compared compared(const Written& written, const Profile& profile, jobs::Streaming streaming) {
  Compared found;
  std::vector<double> driven;
  for (const std::string_view acceleration : {"none", "best", "worst"}) {
    const Way way{profile, streaming, acceleration};
    const PreparedJob job = prepared(written.body, way);
    const jobs::TimeRange takes = job.times().whole();
    driven.push_back(driven_s(job, way));
    expect_within(takes, driven.back(), fmt::format("{} {}", written.file, acceleration));
    found.stated = seconds(takes.most) / seconds(takes.least);
  }
  found.driven = driven.back() / driven.front();
  return found;
}

// On the mill that a job was made for, its range is as narrow as that mill's unknown acceleration allows, so that it is
// useful. On another mill its moves have a different length.
TEST_P(TimesOfWrittenJobs, ContainWhatTheMillTakes) {
  const auto profile = load_profile(profile_file(GetParam()).value().string());
  ASSERT_TRUE(profile);
  const std::vector<Written> jobs = written_jobs();
  ASSERT_EQ(jobs.size(), 40U);
  std::map<std::string, double> widest;
  for (const Written& written : jobs) {
    for (const jobs::Streaming streaming : {jobs::Streaming::full, jobs::Streaming::paced}) {
      const Compared found = compared(written, *profile, streaming);
      if (written.mill != GetParam()) continue;
      const double useful = written.kind.starts_with("relief") ? 4 : 2;
      EXPECT_LE(found.stated, std::max(useful, found.driven * 1.1)) << written.file;
      double& most = widest[streaming == jobs::Streaming::full ? written.kind : "paced"];
      most = std::max(most, found.stated);
    }
  }
  for (const auto& [kind, ratio] : widest) std::cout << fmt::format("| {} | {} | {:.2f} |\n", GetParam(), kind, ratio);
}

INSTANTIATE_TEST_SUITE_P(Mills, TimesOfWrittenJobs, testing::Values("srm-20", "mdx-20", "mdx-15", "mdx-40"));

}  // namespace
}  // namespace axisgate::rml1::job_times_test
