// Random lines under random options: every line has one reply, and the stage stays within its limits.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_robustness_test {
namespace {

using Random = std::mt19937;

constexpr std::int64_t kTravel = 3000;

std::size_t below(Random& random, std::size_t bound) { return random() % bound; }

template <class List>
auto pick(Random& random, const List& list) {
  return list[below(random, std::size(list))];
}

std::string amount(Random& random) {
  static constexpr std::array kUnits = {"P", "U", "N", "M", "", "D"};
  return pick(random, std::array{"+", "-", ""}) + std::string(pick(random, kUnits)) +
         std::to_string(below(random, 2000)) + pick(random, std::array{"", ".0", ".5"});
}

std::string random_line(Random& random) {
  static constexpr std::array kAxes = {"1", "2", "3", "A", "B", "C", "D", "W", ""};
  static constexpr std::array kVerbs = {
      "M:",    "MP:",  "A:",   "AP:", "K:",   "KP:", "J:", "G:",   "G",    "GC:", "L:", "H:", "HRT:",
      "Z:",    "ZRT:", "WT:",  "WI:", "D:",   "DS:", "C:", "BEC:", "R:",   "RC:", "S:", "W:", "L:E",
      "PSET:", "E:0",  "EP:2", "?:M", "?:KP", "Q:S", "Q:", "!:",   "SRQ:", "?:E", "B:", "F:", "SLEEP:"};
  std::string line = std::string(pick(random, kVerbs)) + pick(random, kAxes);
  for (auto count = below(random, 4); count > 0; --count) line += amount(random);
  if (below(random, 4) == 0) line += ",S100F5000R50";
  if (below(random, 6) == 0) line += "S1000F5000R5S100F1000R1S1F1R1";
  if (below(random, 8) == 0) line += "," + std::to_string(below(random, 64));
  if (below(random, 50) == 0) line[below(random, line.size())] = static_cast<char>(below(random, 256));
  if (line.find_first_of("\r\n") != std::string::npos || line.find_first_not_of(" \t") == std::string::npos)
    return "!:";
  return line;
}

Options random_options(Random& random) {
  Options options;
  for (const OptionName& option : option_names()) {
    if (!options.set(option.name, pick(random, option.values))) ADD_FAILURE() << option.name;
  }
  options.axis_setting = static_cast<int>(below(random, 7));
  for (AxisSetup& axis : options.axes) {
    axis.travel_minus_pulses = -kTravel;
    axis.travel_plus_pulses = kTravel;
    axis.origin_pulses = -100;
  }
  return options;
}

bool is_completion(const std::string& line) { return line == "1" || line == "2" || line == "3"; }

// Counts the lines since `from` that cannot be completions; an answer that is a bare digit is not counted.
int replies_since(const SimulatorBench& bench, std::size_t from) {
  int replies = 0;
  for (std::size_t i = from; i < bench.said().size(); ++i) replies += is_completion(bench.said()[i].line) ? 0 : 1;
  return replies;
}

void expect_sound(const SimulatorBench& bench) {
  const auto next = bench.device.next_deadline();
  EXPECT_TRUE(!next || *next > bench.now());
}

TEST(SimulatorRobustness, EveryLineHasOneReply) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const Options options = random_options(random);
    SCOPED_TRACE("seed " + std::to_string(seed) + " " + options.describe());
    SimulatorBench bench({}, options);
    for (int i = 0; i < 200 && !::testing::Test::HasFailure(); ++i) {
      const auto before = bench.said().size();
      const std::string line = random_line(random);
      bench.ask(line);
      // A question about one axis may be answered with a bare digit.
      const int replies = replies_since(bench, before);
      EXPECT_TRUE(replies == 1 || (replies == 0 && line.starts_with("?:M"))) << line << " gave " << replies;
      expect_sound(bench);
      bench.wait(std::chrono::microseconds(below(random, 300'000)));
    }
    bench.device.set_inputs(0);
    bench.rest();
    expect_sound(bench);
    if (::testing::Test::HasFailure()) return;
  }
}

// Once no event is due, an axis is BUSY only if it waits for inputs.
TEST(SimulatorRobustness, EverythingComesToRest) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    SCOPED_TRACE("seed " + std::to_string(seed));
    SimulatorBench bench({}, random_options(random));
    for (int i = 0; i < 100; ++i) {
      bench.ask(random_line(random));
      bench.wait(std::chrono::microseconds(below(random, 300'000)));
    }
    for (int i = 0; i < 20; ++i) {
      bench.ask("WI:W,C");
      bench.rest();
    }
    for (const int axis : {1, 2, 3}) EXPECT_FALSE(bench.device.busy(axis)) << axis;
    if (::testing::Test::HasFailure()) return;
  }
}

// The lines only move axes and change neither counter nor divisions, so the counter is the stage's position.
TEST(SimulatorRobustness, TheStageNeverPassesItsLimits) {
  Random random(7);
  for (int round = 0; round < 50; ++round) {
    SimulatorBench bench({}, random_options(random));
    for (int i = 0; i < 100; ++i) {
      const std::string line = random_line(random);
      if (line.find_first_of("SRHPE") == 0) continue;
      bench.ask(line);
      bench.wait(std::chrono::microseconds(below(random, 500'000)));
      for (const int axis : {1, 2, 3}) ASSERT_LE(std::abs(bench.device.position(axis)), kTravel) << line;
    }
  }
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_robustness_test
