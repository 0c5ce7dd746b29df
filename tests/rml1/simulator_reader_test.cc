// Tests of the simulated mill's parser: the examples typed from the guideline, and the gateway's model of the same
// language on the same jobs. The two share no parser and no machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/rml1/paragraphs.h"
#include "tests/rml1/random_jobs.h"
#include "tests/rml1/simulator_bench.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1::simulator::reader_test {
namespace {

std::string joined(const std::vector<int>& numbers) { return fmt::format("{}", fmt::join(numbers, " ")); }

// Returns errors of the guideline in order; errors with number 0 occur only in a check.
std::string errors_of_check(const Played& played) {
  std::vector<int> numbers;
  for (const Diagnostic& one : played.diagnostics) {
    if (one.severity == Severity::error && one.number != 0) numbers.push_back(one.number);
  }
  return joined(numbers);
}

std::string errors_of_mill(const MillBench& bench) {
  std::vector<int> numbers;
  for (const std::string& line : bench.recorded("error")) numbers.push_back(std::stoi(line.substr(line.find(':') + 1)));
  return joined(numbers);
}

// Returns waits in the format of Played: "spin up 2", "dwell 0.5".
std::vector<std::string> waits_of_mill(const MillBench& bench) {
  std::vector<std::string> waits;
  for (const std::string& line : bench.recorded("wait")) {
    const std::string seconds = line.substr(line.rfind(':') + 1);
    waits.push_back((line.find("dwell") != std::string::npos ? "dwell " : "spin up ") + seconds);
  }
  return waits;
}

// Plays the job byte by byte, each executed before the next, with a delimiter that ends the last command.
void play_at_leisure(MillBench& bench, const std::string& job) {
  for (const char byte : job + ";") {
    bench.send({&byte, 1});
    bench.finish();
    if (bench.mill.state(bench.now).paused != "no") bench.mill.press_view(bench.now);
  }
}

// Returns all examples except those for a parser with an additional row, and those in which ESC.K is an error of the
// check.
std::vector<Paragraph> examples_for_a_mill() {
  std::vector<Paragraph> examples = paragraphs("examples");
  std::erase_if(examples, [](const Paragraph& example) {
    const bool has_escape_k = unescaped(example.all("<").at(0)).find("\x1B.K") != std::string::npos;
    return has_escape_k || !example.all("%").empty();
  });
  return examples;
}

class MillExamples : public testing::TestWithParam<Paragraph> {};

TEST_P(MillExamples, GiveTheErrorsOfTheGuideline) {
  const std::string job = unescaped(GetParam().all("<").at(0));
  std::vector<int> expected;
  for (const std::string& error : GetParam().all("!")) {
    if (const int number = std::stoi(error)) expected.push_back(number);
  }
  MillBench bench;
  bench.mill.set_z0(0, bench.now);  // the whole travel is below Z0, as for a job with an unknown origin
  play_at_leisure(bench, job);
  EXPECT_EQ(errors_of_mill(bench), joined(expected)) << GetParam().all("<")[0];
}

INSTANTIATE_TEST_SUITE_P(Guideline, MillExamples, testing::ValuesIn(examples_for_a_mill()), [](const auto& one) {
  std::string name;
  for (const char c : one.param.where) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

// Reports whether the errors are few enough for the check to keep all of them.
bool has_few_errors(const MillBench& bench) { return bench.recorded("error").size() <= Diagnostics::kSame; }

TEST(MillAndCheck, AgreeOnErrorsWaitsAndWhereTheToolEnds) {
  std::mt19937 random(1);
  for (int round = 0; round < 10000; ++round) {
    const std::string job = random_job(random);
    MillBench bench;
    play_at_leisure(bench, job);
    Played played = play(job + ";", test_profile(), kMidway);
    // The mill records a turn by its angle: agreement_test.cc.
    std::erase_if(played.waits, [](const std::string& wait) { return wait.starts_with("turn"); });
    if (has_few_errors(bench)) {
      ASSERT_EQ(errors_of_mill(bench), errors_of_check(played)) << job;
    }
    ASSERT_EQ(waits_of_mill(bench), played.waits) << job;
    const Machine::Point at = bench.mill.state(bench.now).tool;
    ASSERT_NEAR(at.x, played.final.x, 1e-6) << job;
    ASSERT_NEAR(at.y, played.final.y, 1e-6) << job;
    ASSERT_NEAR(at.z, played.final.z, 1e-6) << job;
  }
}

TEST(MillReader, AnySplitOfTheBytesIsTheSame) {
  const std::string job = "P A1000 , 0;D10,10,20;!Z E X5 Y6:Z-3;^PU 3.5,.5 ^ D,F;!1;J2;PD1,2,3\r\nI 5 5";
  MillBench whole, pieces;
  whole.send(job);
  whole.finish();
  for (const char byte : job) pieces.send({&byte, 1});
  pieces.finish();
  EXPECT_EQ(pieces.tool(), whole.tool());
  EXPECT_EQ(pieces.recorded("error"), whole.recorded("error"));
}

TEST(MillReader, TakesWhatTheProfileTolerates) {
  MillSetup setup;
  setup.profile = test_profile();
  setup.profile.dialect.tolerated = {"J", "!0", "!1"};
  MillBench bench(setup);
  bench.send("!0;J3;PU100,0;");
  bench.finish();
  EXPECT_EQ(bench.errors(), "none");
  EXPECT_THAT(bench.recorded("spindle"), testing::IsEmpty());
  bench.send("!1;PU0,0;");
  bench.finish();
  EXPECT_THAT(bench.recorded("spindle"), testing::ElementsAre("\"spindle\":6500"));
}

}  // namespace
}  // namespace axisgate::rml1::simulator::reader_test
