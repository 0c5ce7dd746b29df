// Commands per second on one CPU core: read, checked with machine and time, and drawn. Compare only figures of one run.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "device/rml1/picture/picture.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

constexpr int kCommands = 150'000;

// Returns a relief as CAM programs write it: three axes per command, and an occasional lift.
const std::string& job() {
  static const std::string text = [] {
    std::string made = ";;^IN;\n!MC1;\nV10.0;^PA;\n";
    for (int index = 4; index < kCommands; ++index) {
      const double turn = index * 0.01;
      const int z = index % 500 == 0 ? 200 : -100 - index % 97;
      made += fmt::format("Z{},{},{};\n", 30'000 + std::lround(20'000 * std::cos(turn)),
                          30'000 + std::lround(20'000 * std::sin(turn)), z);
    }
    return made;
  }();
  return text;
}

class Nobody : public ParserListener {
 public:
  void execute(const Instruction& instruction) override { benchmark::DoNotOptimize(instruction.values); }
  void quit() override {}
};

void Parse(benchmark::State& state) {
  for (auto _ : state) {
    Diagnostics diagnostics;
    Nobody nobody;
    Parser parser({}, diagnostics, nobody);
    parser.feed(job());
    parser.finish();
    benchmark::DoNotOptimize(parser.commands());
  }
  state.SetItemsProcessed(state.iterations() * kCommands);
}
BENCHMARK(Parse)->Unit(benchmark::kMillisecond);

void CheckWithMachineAndTime(benchmark::State& state) {
  const Profile profile = test_profile();
  for (auto _ : state) {
    Check check(profile, {.origin = jobs::Origin{0, 0, 30}, .stock = {}, .others = {}});
    check.feed(job());
    check.finish();
    benchmark::DoNotOptimize(check.summary());
  }
  state.SetItemsProcessed(state.iterations() * kCommands);
}
BENCHMARK(CheckWithMachineAndTime)->Unit(benchmark::kMillisecond);

// Checks and draws a job. The difference to the check above is the cost of drawing.
void Preview(benchmark::State& state) {
  const Profile profile = test_profile();
  for (auto _ : state) {
    Strokes strokes;
    Check check(profile, {.origin = jobs::Origin{0, 0, 30}, .stock = {}, .others = {}}, &strokes);
    check.feed(job());
    check.finish();
    const std::string svg = to_svg(make_picture("bench", {&check}, profile, {}, true, strokes));
    benchmark::DoNotOptimize(svg.size());
  }
  state.SetItemsProcessed(state.iterations() * kCommands);
}
BENCHMARK(Preview)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace axisgate::rml1

BENCHMARK_MAIN();
