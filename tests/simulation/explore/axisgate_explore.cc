// axisgate-explore: runs the same trials as the ordinary tests, any number of seeds of any length. For a failure it
// leaves out faults, and prints the shortest history that still fails.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <string>

#include "tests/guards/table.h"
#include "tests/simulation/trial.h"

namespace axisgate::simulation {
namespace {

constexpr int kShrinkRunsMax = 400;

struct Arguments {
  std::uint64_t seeds = 100;
  double hours = 16;
  std::string profile = "hostile";
  std::uint64_t first_seed = 0;
  std::string without;
  bool shapes = false, stops = false, digests = false;
};

struct Totals {
  std::uint64_t seeds = 0, failures = 0, exchanges = 0, barriers = 0;
  Duration virtual_time{};
  std::map<std::string, Wire::ByPhase> faults;

  void add(const TrialResult& result) {
    ++seeds;
    failures += result.violation ? 1 : 0;
    exchanges += result.exchanges;
    barriers += result.barriers;
    virtual_time += result.virtual_time;
    for (const auto& [kind, phases] : result.faults) {
      for (std::size_t phase = 0; phase < phases.size(); ++phase) faults[kind][phase] += phases[phase];
    }
  }
};

double hours(Duration time) { return std::chrono::duration<double>(time).count() / 3600; }

// Prints the totals as a Markdown table.
void print(const Totals& totals) {
  fmt::print("{} seeds, {:.1f} virtual hours, {} exchanges, {} barriers, {} violations\n\n", totals.seeds,
             hours(totals.virtual_time), totals.exchanges, totals.barriers, totals.failures);
  fmt::print("| {:<22} |", "fault");
  for (const auto phase : kPhaseNames) fmt::print(" {:>12} |", phase);
  fmt::print("\n|{:-<24}|", "");
  for (std::size_t i = 0; i < kPhaseNames.size(); ++i) fmt::print("{:->13}:|", "");
  fmt::print("\n");
  for (const auto& [kind, phases] : totals.faults) {
    fmt::print("| {:<22} |", kind);
    for (const auto count : phases) fmt::print(" {:>12} |", count);
    fmt::print("\n");
  }
}

void tell_failure(const Trial& trial, const TrialResult& result) {
  fmt::print("seed {}: {} (after {:.3f} virtual seconds, {} faults)\n", trial.seed, *result.violation,
             std::chrono::duration<double>(result.virtual_time).count(), result.faults_drawn);
  const TrialResult shortest = run(shrunk(trial, kShrinkRunsMax));
  std::uint64_t struck = 0;
  for (const auto& [kind, phases] : shortest.faults) {
    for (const auto count : phases) struck += count;
  }
  fmt::print("the shortest history found has {} faults: {}\n{}\n", struck, *shortest.violation, shortest.replay);
}

int explore(const Arguments& arguments) {
  Totals totals;
  for (std::uint64_t i = 0; i < arguments.seeds; ++i) {
    Trial trial;
    trial.seed = arguments.first_seed + i;
    trial.faults = *Faults::named(arguments.profile);
    trial.habits = {.shapes = arguments.shapes, .stop_at_faults = arguments.stops};
    trial.duration = std::chrono::duration_cast<Duration>(
        std::chrono::duration<double>(arguments.hours * 3600 / static_cast<double>(arguments.seeds)));
    const TrialResult result = run(trial);
    totals.add(result);
    if (arguments.digests) fmt::print("{} {:016x}\n", trial.seed, result.digest);
    if (result.violation) tell_failure(trial, result);
    std::fflush(stdout);
  }
  if (!arguments.digests) print(totals);
  return totals.failures == 0 ? 0 : 1;
}

int list_guards() {
  for (const auto& row : guards::table()) fmt::print("{:<38} {}\n", row.name, row.what);
  return 0;
}

int main_program(int count, char** words) {
  CLI::App program(
      "Runs the controller's core against the simulator in virtual time, with faults, and looks for\n"
      "anything that must not happen. Exit code 1 if it found something.",
      "axisgate-explore");
  Arguments arguments;
  program.add_option("--seeds", arguments.seeds, "How many seeds")->capture_default_str()->check(CLI::PositiveNumber);
  program.add_option("--hours", arguments.hours, "Virtual hours in all, shared among the seeds")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  program.add_option("--profile", arguments.profile, "How bad line and device are")
      ->capture_default_str()
      ->check(CLI::IsMember({"quiet", "mild", "rough", "hostile"}));
  program.add_option("--seed", arguments.first_seed, "The first seed")->capture_default_str();
  program.add_option("--without", arguments.without, "Removes this guard")->check([](const std::string& name) {
    return guards::row_named(name) ? "" : "there is no guard " + name + "; --list-guards names them";
  });
  program.add_flag("--shapes", arguments.shapes, "Callers draw curves, rest, come from one side, and scan, too");
  program.add_flag("--stops", arguments.stops, "Somebody stops the stage at each fault of the line");
  program.add_flag("--digests", arguments.digests, "Prints one number for what each seed did, instead of the totals");
  bool list = false;
  program.add_flag("--list-guards", list, "Names the guards");
  CLI11_PARSE(program, count, words);
  if (list) return list_guards();
  if (const auto* removed = guards::row_named(arguments.without)) removed_guard = removed->guard;
  return explore(arguments);
}

}  // namespace
}  // namespace axisgate::simulation

int main(int count, char** words) { return axisgate::simulation::main_program(count, words); }
