// Removes each guard of mill jobs in turn; the seeds of a mill on a bad line must then fail.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "device/jobs/guard.h"
#include "tests/rml1/bad_line.h"

namespace axisgate::rml1 {
namespace {

struct MillRow {
  jobs::MillGuard guard;
  std::string_view name, what;
};
void PrintTo(const MillRow& row, std::ostream* out) { *out << row.name; }

// Guards in the order of the enumeration.
constexpr std::array kMillTable = {
    MillRow{jobs::MillGuard::window, "window", "paced: no more than the window is ahead of the slowest mill"},
    MillRow{jobs::MillGuard::window_fits_buffer, "window-fits-buffer", "... and no more than the mill's buffer takes"},
    MillRow{jobs::MillGuard::one_command_unsent, "one-command-unsent", "at most one command waits in the host"},
    MillRow{jobs::MillGuard::nothing_while_held, "nothing-while-held", "nothing is written while CTS is low"},
    MillRow{jobs::MillGuard::counted_from_arrival, "counted-from-arrival",
            "what waits on this side of a line that is held has not been executed"},
    MillRow{jobs::MillGuard::abort_ends_job, "abort-ends-job", "nothing of a job is written after its abort"},
    MillRow{jobs::MillGuard::abort_is_not_held, "abort-is-not-held",
            "an abort leaves the host, whatever flow control says"},
    MillRow{jobs::MillGuard::abort_after_loss, "abort-after-loss", "the abort comes first when the line is back"},
    MillRow{jobs::MillGuard::fed_by_the_slowest, "fed-by-the-slowest", "FED: the slowest mill has executed all"},
    MillRow{jobs::MillGuard::fed_when_arrived, "fed-when-arrived", "... and nothing waits, and CTS is high"},
    MillRow{jobs::MillGuard::converter_in_range, "converter-in-range",
            "what a converter held is not said to be received when the line breaks"},
    MillRow{jobs::MillGuard::void_after_abort, "void-after-abort", "a confirmation is void after an abort"},
    MillRow{jobs::MillGuard::void_after_loss, "void-after-loss", "... and after the line was lost"},
    MillRow{jobs::MillGuard::settled_before_next, "settled-before-next",
            "no job is confirmed before it is known what became of the last one"},
};

constexpr std::uint64_t kSeedsTried = 500;

class WithoutMillGuard {
 public:
  explicit WithoutMillGuard(jobs::MillGuard guard) { jobs::removed_mill_guard = guard; }
  ~WithoutMillGuard() { jobs::removed_mill_guard.reset(); }
  WithoutMillGuard(const WithoutMillGuard&) = delete;
  WithoutMillGuard& operator=(const WithoutMillGuard&) = delete;
};

LineFaultRun run_without(jobs::MillGuard guard, std::uint64_t seed) {
  const WithoutMillGuard without(guard);
  return BadLine(seed).run();
}

class RemovedMillGuard : public testing::TestWithParam<MillRow> {};

TEST_P(RemovedMillGuard, IsMissed) {
  const MillRow& row = GetParam();
  for (std::uint64_t seed = 0; seed < kSeedsTried; ++seed) {
    const LineFaultRun run = run_without(row.guard, seed);
    if (!run.violation) continue;
    ASSERT_FALSE(BadLine(seed).run().violation) << "seed " << seed << " fails with all guards, too";
    return fmt::print("| {} | {} | seed {} | {} |\n", row.name, row.what, seed, *run.violation);
  }
  FAIL() << fmt::format("guard {} removed, seeds 0 to {}: nothing was detected", row.name, kSeedsTried - 1);
}

INSTANTIATE_TEST_SUITE_P(Guards, RemovedMillGuard, testing::ValuesIn(kMillTable), [](const auto& row) {
  std::string name(row.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(MillGuardTable, HasOneRowForEachGuard) {
  ASSERT_EQ(kMillTable.size(), static_cast<std::size_t>(jobs::kMillGuards));
  for (std::size_t i = 0; i < kMillTable.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(kMillTable.at(i).guard), i);
}

}  // namespace
}  // namespace axisgate::rml1
