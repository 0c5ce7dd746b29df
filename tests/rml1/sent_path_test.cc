// Test that the path of a sent job equals the path that the check has played: bytes sent around a job must not complete
// or extend one of its commands.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include "device/rml1/check/check.h"
#include "device/rml1/machine/profile_files.h"
#include "device/rml1/mill/prepared_job.h"
#include "tests/paths/paths.h"
#include "tests/rml1/courses.h"
#include "tests/rml1/mill.h"
#include "tests/rml1/paragraphs.h"
#include "tests/rml1/random_jobs.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1::sent_path_test {
namespace {

using Kind = Course::Event::Kind;

constexpr unsigned kSeeds = 300;
constexpr int kCutsOfAJob = 12;

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Removes !NR, which waits for a person.
std::string without_waits(std::string text) {
  for (auto at = text.find("!NR"); at != std::string::npos; at = text.find("!NR")) text.replace(at, 3, ";");
  return text;
}

template <class IsJob>
std::vector<std::string> jobs_in(const std::filesystem::path& folder, IsJob is_job) {
  std::vector<std::string> jobs;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (is_job(entry.path().extension())) jobs.push_back(without_waits(contents(entry.path())));
  }
  return jobs;
}

// Returns the jobs that tests/jobs writes. They have the file name endings that many programs use; the table beside
// them is skipped.
std::vector<std::string> written_jobs() {
  return jobs_in(paths::written_jobs(), [](const std::string& ending) { return ending != ".tsv"; });
}

std::vector<std::string> kept_jobs() {
  return jobs_in(paths::in_project("tests"),
                 [](const std::string& ending) { return ending == ".rml" || ending == ".prn"; });
}

std::vector<std::string> typed_jobs() {
  std::vector<std::string> jobs;
  for (const Paragraph& example : paragraphs("examples")) {
    const bool half = example.all("<").at(0).find(".5") != std::string::npos;
    if (!half && example.all("%").empty()) jobs.push_back(without_waits(unescaped(example.all("<").at(0))));
  }
  return jobs;
}

bool is_refused(const std::string& job, const Profile& profile) {
  Check check(profile, {.origin = kWork, .stock = {}, .others = {}});
  check.feed(job);
  check.finish();
  return check.diagnostics().count(Severity::error) > 0;
}

// Expects at most one more event: the tool goes straight up after the last step of the job.
void expect_only_a_lift(std::span<const Course::Event> events, const Course::Event* last, const std::string& job) {
  ASSERT_LE(events.size(), 1U) << job;
  if (events.empty()) return;
  ASSERT_EQ(events[0].kind, Kind::moved) << job;
  EXPECT_EQ(events[0].to.h, 0) << job;
  if (last == nullptr) return;
  EXPECT_DOUBLE_EQ(events[0].to.x, last->to.x) << job;
  EXPECT_DOUBLE_EQ(events[0].to.y, last->to.y) << job;
}

const Course::Event* last_move(const std::vector<Course::Event>& events) {
  const auto found =
      std::find_if(events.rbegin(), events.rend(), [](const auto& one) { return one.kind == Kind::moved; });
  return found == events.rend() ? nullptr : &*found;
}

// Compares the courses. Returns false if the job has an error, because it is then not sent.
bool compare(const std::string& job, const Profile& profile) {
  if (is_refused(job, profile)) return false;
  simulator::MillSetup setup = simulator::with_options({{"acceleration", "none"}});
  setup.profile = profile;
  const PreparedJob sent(job, "d", profile, kWork, jobs::SendSettings());
  const Course played = course_of_model(job, profile), driven = course_of_mill(sent.text(), setup);
  EXPECT_GE(driven.events.size(), played.events.size()) << job;
  if (driven.events.size() < played.events.size()) return true;
  for (std::size_t i = 0; i < played.events.size(); ++i) {
    EXPECT_EQ(driven.events[i], played.events[i]) << "event " << i << " of " << job;
    if (!(driven.events[i] == played.events[i])) return true;
  }
  expect_only_a_lift(std::span(driven.events).subspan(played.events.size()), last_move(played.events), job);
  return true;
}

// Compares with the first mill that accepts the job.
bool compare_with_any(const std::string& job, const std::vector<Profile>& profiles) {
  return std::ranges::any_of(profiles, [&](const Profile& profile) { return compare(job, profile); });
}

std::vector<Profile> profiles() {
  std::vector<Profile> all;
  for (const auto& file : shipped_profiles()) all.push_back(load_profile(file).value());
  return all;
}

TEST(SentPath, IsThatOfTheCheckForEachJobOfTheTests) {
  const std::vector<Profile> mills = profiles();
  const std::vector<std::string> written = written_jobs();
  EXPECT_EQ(written.size(), 60U);
  for (const std::string& job : written) EXPECT_TRUE(compare_with_any(job, mills)) << job.substr(0, 200);
  int compared = 0;
  for (const std::string& job : kept_jobs()) compared += compare_with_any(job, mills);
  for (const std::string& job : typed_jobs()) compared += compare(job, test_profile());
  EXPECT_GE(compared, 300);
}

// A file may lack its end, from the middle of a command on.
TEST(SentPath, IsThatOfTheCheckWhereverAJobIsCutOff) {
  const Profile profile = test_profile();
  std::vector<std::string> jobs = typed_jobs();
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937 random(seed);
    jobs.push_back(without_waits(random_job(random)));
  }
  std::mt19937 random(1);
  int compared = 0;
  for (const std::string& job : jobs) {
    for (int i = 0; i < kCutsOfAJob && !job.empty(); ++i)
      compared += compare(job.substr(0, random() % job.size()), profile);
  }
  EXPECT_GE(compared, 2000);
}

TEST(SentPath, OfAnOpenGroupIsNotDriven) {
  const Profile profile = test_profile();
  EXPECT_TRUE(compare("^IN;PU100,100;!ZEX500", profile));
  EXPECT_TRUE(compare("^IN;PU100,100;!ZE X300:Y200", profile));
  EXPECT_TRUE(compare("PU100,100;^!ZEX500", profile));
  const PreparedJob sent("PU100,100;!ZEX500", "d", profile, kWork, jobs::SendSettings());
  EXPECT_EQ(sent.text().find("ZE"), std::string::npos) << sent.text();
}

// Otherwise a job could be paused and raised after its end, and would have a rest without a command.
TEST(SentPath, TheWholePartCountsAsSentWithoutItsOpenEnd) {
  const PreparedJob sent("PU100,100;!ZEX500", "d", test_profile(), kWork, jobs::SendSettings());
  EXPECT_EQ(sent.of_body(sent.text().size()), 17U);
  EXPECT_EQ(sent.of_body(sent.text().find(";^DF") + 4), 0U);
}

}  // namespace
}  // namespace axisgate::rml1::sent_path_test
