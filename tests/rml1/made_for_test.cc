// Test of warnings about a job for another mill: a check with the wrong mill must warn, a check with the right mill
// must not. The jobs imitate many programs, and were written without knowledge of the rules.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "device/rml1/check/check.h"
#include "device/rml1/machine/profile_files.h"
#include "tests/paths/paths.h"

namespace axisgate::rml1 {
namespace {

struct MadeJob {
  std::string file, mill, bytes;
};

std::vector<MadeJob> made_jobs() {
  std::vector<MadeJob> jobs;
  std::ifstream table(paths::written_jobs() / "jobs.tsv");
  std::string line;
  std::getline(table, line);  // names of the columns
  while (std::getline(table, line)) {
    MadeJob job;
    std::istringstream(line) >> job.file >> job.mill;
    std::ifstream in(paths::written_jobs() / job.file, std::ios::binary);
    job.bytes.assign(std::istreambuf_iterator<char>(in), {});
    jobs.push_back(std::move(job));
  }
  return jobs;
}

enum class Verdict { silent, warned, refused };

Verdict verdict_on(const MadeJob& job, const Profile& profile, const std::vector<KnownMachine>& others) {
  Check check(profile, {.origin = {}, .stock = {}, .others = others});
  check.feed(job.bytes);
  check.finish();
  if (check.diagnostics().count(Severity::error) > 0) return Verdict::refused;
  const auto all = check.diagnostics().in_order();
  const bool warned =
      std::ranges::find(all, std::optional(Warning::made_for_another_mill), &Diagnostic::warning) != all.end();
  return warned ? Verdict::warned : Verdict::silent;
}

// Goals: at most 5 % of the jobs for a mill with another step size cause no warning, and at most 2 % cause a warning on
// the mill that they were made for.
TEST(MadeFor, IsNoticedAcrossManyPrograms) {
  const std::vector<MadeJob> jobs = made_jobs();
  ASSERT_EQ(jobs.size(), 60U);
  const std::vector<KnownMachine> others = known_machines();
  int wrong = 0, silent = 0, refused = 0, false_alarms = 0;
  std::string which;
  for (const auto& file : shipped_profiles()) {
    const Profile profile = load_profile(file.string()).value();
    for (const MadeJob& job : jobs) {
      const bool right = file.stem() == job.mill;
      const auto made_for = load_profile((file.parent_path() / (job.mill + ".toml")).string()).value();
      if (!right && made_for.step_mm == profile.step_mm) continue;  // same size on both mills
      const Verdict verdict = verdict_on(job, profile, others);
      wrong += !right;
      refused += !right && verdict == Verdict::refused;
      silent += !right && verdict == Verdict::silent;
      false_alarms += right && verdict == Verdict::warned;
      if (right ? verdict == Verdict::warned : verdict == Verdict::silent) {
        which += fmt::format("{} ({}) on {}; ", job.file, job.mill, profile.name);
      }
    }
  }
  const std::string figures = fmt::format("{} wrong: {} refused, {} silent; 60 right: {} false alarms: {}", wrong,
                                          refused, silent, false_alarms, which);
  RecordProperty("figures", figures);
  EXPECT_LE(silent * 100, wrong * 5) << figures;
  EXPECT_LE(false_alarms * 100, 60 * 2) << figures;
}

}  // namespace
}  // namespace axisgate::rml1
