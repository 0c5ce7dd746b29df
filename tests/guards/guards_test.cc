// Removes each guard in turn; a test must then fail. A guard whose removal goes unnoticed is unnecessary or untested.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "tests/guards/table.h"
#include "tests/simulation/trial.h"

namespace axisgate::guards {

void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

namespace {

constexpr unsigned kChildSecondsMax = 120;
const std::string kWithout = "--without=";

void print(const Row& row, const std::string& proof, std::string what) {
  what = what.substr(0, what.find('\n'));
  std::replace(what.begin(), what.end(), '|', '/');
  fmt::print("| {} | {} | {} |\n", row.name, proof, what);
  std::fflush(stdout);
}

void expect_caught_by_seeds(const Row& row) {
  const Seeds& seeds = *row.seeds;
  Without none(row.guard);
  for (int i = 0; i < seeds.count; ++i) {
    simulation::Trial trial;
    trial.seed = seeds.first + static_cast<std::uint64_t>(i);
    trial.faults = *simulation::Faults::named(seeds.profile);
    trial.duration = std::chrono::minutes(seeds.minutes);
    const auto result = simulation::run(trial);
    if (!result.violation) continue;
    removed_guard.reset();
    ASSERT_FALSE(simulation::run(trial).violation) << "seed " << trial.seed << " fails with all guards, too";
    const double seconds = std::chrono::duration<double>(result.virtual_time).count();
    return print(row,
                 fmt::format("seed {} of {} to {}, after {:.1f} s", trial.seed, seeds.first,
                             seeds.first + static_cast<std::uint64_t>(seeds.count) - 1, seconds),
                 *result.violation);
  }
  FAIL() << fmt::format("guard {} removed, seeds {} to {} for {} virtual minutes each: nothing was caught", row.name,
                        seeds.first, seeds.first + static_cast<std::uint64_t>(seeds.count) - 1, seeds.minutes);
}

struct Output {
  std::string text;
  int status = 0;
};

// Runs the row's tests in a separate process, so that a crash does not count as a failure.
Output run_tests_of(const Row& row, const std::string& option) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").string();
  const auto command = fmt::format(
      "env --unset=GTEST_TOTAL_SHARDS --unset=GTEST_SHARD_INDEX '{}' {} --gtest_filter='{}' --gtest_color=no 2>&1",
      program, option, row.tests);
  Output output;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return output;
  std::array<char, 4096> block{};
  while (std::fgets(block.data(), block.size(), pipe)) output.text += block.data();
  output.status = pclose(pipe);
  return output;
}

void expect_caught_by_tests(const Row& row) {
  const Output control = run_tests_of(row, "");
  ASSERT_EQ(control.status, 0) << row.tests << " fails with all guards, too\n" << control.text;
  const Output output = run_tests_of(row, kWithout + std::string(row.name));
  const std::string failed = "[  FAILED  ] ";
  const auto at = output.text.find(failed);
  ASSERT_TRUE(WIFEXITED(output.status) && (at == std::string::npos || WEXITSTATUS(output.status) == 1))
      << "guard " << row.name << " removed: not a failure, but a crash or no end\n"
      << output.text;
  ASSERT_NE(at, std::string::npos) << "guard " << row.name << " removed, " << row.tests << ": nothing was caught\n"
                                   << output.text;
  const auto name = output.text.substr(at + failed.size());
  print(row, "test " + std::string(row.tests), name.substr(0, name.find_first_of(" ,\n")));
}

class Removed : public testing::TestWithParam<Row> {};

TEST_P(Removed, IsMissed) {
  if (GetParam().seeds) {
    expect_caught_by_seeds(GetParam());
  } else {
    expect_caught_by_tests(GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Guards, Removed, testing::ValuesIn(table().begin(), table().end()), [](const auto& row) {
  std::string name(row.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(GuardTable, HasOneRowForEachGuard) {
  std::set<std::string_view> names;
  ASSERT_EQ(table().size(), static_cast<std::size_t>(kGuards));
  for (int i = 0; i < kGuards; ++i) {
    const Row& row = table()[static_cast<std::size_t>(i)];
    EXPECT_EQ(static_cast<int>(row.guard), i) << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_NE(row.seeds.has_value(), !row.tests.empty()) << row.name << ": by seeds or by tests";
    EXPECT_TRUE(!row.seeds || simulation::Faults::named(row.seeds->profile)) << row.name;
  }
}

}  // namespace

// Runs the tests. A child of this program also calls it, with one guard removed for all tests.
int run_tests(int count, char** words) {
  testing::InitGoogleTest(&count, words);
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const Row* row = word.starts_with(kWithout) ? row_named(word.substr(kWithout.size())) : nullptr;
    if (!row) {
      fmt::print(stderr, "{}: not an option of this program\n", word);
      return 2;
    }
    removed_guard = row->guard;
    alarm(kChildSecondsMax);
  }
  return RUN_ALL_TESTS();
}

}  // namespace axisgate::guards

int main(int count, char** words) { return axisgate::guards::run_tests(count, words); }
