// Tests of each NG condition in the manual, for each command that it names: the simulator refuses, and the gateway
// reports the reason. With AXISGATE_WRITE_REFUSALS=1 in the environment, the test writes device/shrc203/REFUSALS.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/paths/paths.h"
#include "tests/refusals/page.h"

namespace axisgate::refusals {
namespace {

constexpr std::string_view kHowToWrite =
    "AXISGATE_WRITE_REFUSALS=1 build/bin/refusals_tests --gtest_filter='RefusalsPage.*'";

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::vector<Condition>& all_conditions() {
  static const std::vector<Condition> kept = conditions();
  return kept;
}

std::string described(const Verdict& told) {
  if (!told.problem) {
    return fmt::format("no problem, {} replies, ended: {}\n{}", told.answers.size(), told.ended, told.replay);
  }
  return fmt::format("{}: {} ({})", name(told.problem->reason), told.problem->message, told.problem->hint);
}

// Returns the fault in the gateway's problem; empty if it is as expected.
std::string wrong_with(const Condition& condition, const Case& one, const Verdict& told) {
  const Reason wanted = one.reason == Reason::unspecified ? condition.reason : one.reason;
  if (!told.problem || told.problem->reason != wanted) return fmt::format("not {}", name(wanted));
  if (told.problem->message.find(condition.told) == std::string::npos) return "does not tell " + condition.told;
  if (told.problem->hint.empty()) return "does not say what helps";
  return {};
}

class Ng : public testing::TestWithParam<const Condition*> {};

TEST_P(Ng, TheSimulatorRefuses) {
  for (const Case& one : GetParam()->cases) EXPECT_EQ(at_simulator(*GetParam(), one), "NG") << one.line;
}

// The condition becomes true as the line arrives, so the gateway learns about it from NG.
TEST_P(Ng, TheGatewaySaysWhy) {
  for (const Case& one : GetParam()->cases) {
    const Verdict told = at_gateway(*GetParam(), one, Moment::as_it_arrives);
    EXPECT_EQ(wrong_with(*GetParam(), one, told), "") << one.line << ": " << described(told);
  }
}

TEST_P(Ng, TheGatewayKnowsItBefore) {
  if (!GetParam()->strikes_early) return;
  for (const Case& one : GetParam()->cases) {
    const Verdict told = at_gateway(*GetParam(), one, Moment::before);
    EXPECT_EQ(wrong_with(*GetParam(), one, told), "") << one.line << ": " << described(told);
    if (GetParam()->never_sent(*one.sentence)) {
      EXPECT_EQ(told.sent, 0) << one.line;
    }
  }
}

std::vector<const Condition*> each_condition() {
  std::vector<const Condition*> each;
  for (const Condition& condition : all_conditions()) each.push_back(&condition);
  return each;
}

INSTANTIATE_TEST_SUITE_P(Conditions, Ng, testing::ValuesIn(each_condition()), [](const auto& one) {
  std::string name;
  for (const char c : one.param->name) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

// In the ordinary state every command is accepted, so a simulator that always refuses fails this test.
TEST(Ordinary, TheSimulatorTakesEachCommand) {
  const Condition nothing;
  for (const Sentence& sentence : sentences()) {
    Case one{&sentence, sentence.line, sentence.whole(), sentence.way_there(), {}};
    // Only a running program can be paused.
    if (sentence.command == "P:U") one.simulator_before.push_back("P:S");
    const std::string answer = at_simulator(nothing, one);
    EXPECT_FALSE(answer.empty() || answer.find("NG") != std::string::npos) << sentence.line << " -> " << answer;
  }
}

// Excludes JD:, which only Jog sends, and P:U, because the gateway waits for the end of P:S.
TEST(Ordinary, TheGatewayTakesEachCommand) {
  const Condition nothing;
  for (const Sentence& sentence : sentences()) {
    if (sentence.command == "JD:" || sentence.command == "P:U") continue;
    const Case one{&sentence, sentence.line, sentence.whole(), {}, {}};
    const Verdict told = at_gateway(nothing, one, Moment::before);
    EXPECT_TRUE(told.ended && !told.problem) << sentence.line << ": " << described(told);
    EXPECT_EQ(told.sent, 1) << sentence.line;
  }
}

// "In the case of the motor excitation is OFF, it will be NG" (65)), but the axis is stationary.
TEST(Stop, OfAnAxisWithoutExcitationIsNoProblem) {
  const Sentence& stop = sentence("L:");
  const Condition off{.name = "Motor excitation OFF", .manual = "65)", .strikes = [](Device& device, TimePoint now) {
                        device.set_excitation(1, false, now);
                      }};
  const Case one{&stop, stop.line, {stop.line}, {}, {}};
  EXPECT_EQ(at_simulator(off, one), "NG");
  const Verdict told = at_gateway(off, one, Moment::as_it_arrives);
  EXPECT_EQ(told.answers, Lines{"NG"});
  EXPECT_TRUE(told.ended && !told.problem) << described(told);
}

// "It can be used only during operation with the J: command" (93)): a condition that ends the jog also refuses JD:.
TEST(FasterJog, EndsWithTheReasonOfTheRefusal) {
  int tried = 0;
  for (const Condition& condition : all_conditions()) {
    const bool ends_a_jog = condition.name == "Motor excitation OFF" || condition.name == "Limit sensor detected" ||
                            condition.name == "Emergency stop";
    if (!ends_a_jog) continue;
    ++tried;
    const Verdict told = of_a_faster_jog(condition);
    EXPECT_TRUE(told.ended) << condition.name;
    EXPECT_EQ(told.answers.empty() ? "nothing" : told.answers.front(), "NG") << condition.name << "\n" << told.replay;
    EXPECT_EQ(wrong_with(condition, {}, told), "") << condition.name << ": " << described(told);
  }
  EXPECT_EQ(tried, 3);
}

TEST(Manual, EachSectionIsThereOnce) {
  int section = 0;
  for (const Sentence& sentence : sentences()) EXPECT_EQ(sentence.section, ++section) << sentence.command;
  EXPECT_EQ(section, 136);
}

TEST(RefusalsPage, IsWhatTheTrialsTold) {
  std::vector<Outcome> outcomes;
  for (const Condition& condition : all_conditions()) {
    for (const Case& one : condition.cases) {
      Outcome outcome{&condition, &one, at_gateway(condition, one, Moment::as_it_arrives), true};
      const bool early = condition.strikes_early && condition.strikes;
      outcome.sent = (early ? at_gateway(condition, one, Moment::before) : outcome.told).sent > 0;
      outcomes.push_back(std::move(outcome));
    }
  }
  const auto codes = codes_by_reason(content(paths::in_project("proto/axisgate/v1/common.proto")));
  const std::filesystem::path path = paths::in_project("device/shrc203/REFUSALS.md");
  const std::string wanted = refusals_page(outcomes, codes);
  EXPECT_EQ(wanted.find("| - |"), std::string::npos) << "a reason without its gRPC code in common.proto";
  const char* write = std::getenv("AXISGATE_WRITE_REFUSALS");
  if (write != nullptr && std::string_view(write) == "1") std::ofstream(path, std::ios::binary) << wanted;
  EXPECT_TRUE(content(path) == wanted) << "device/shrc203/REFUSALS.md is not what the gateway tells\nwrite it anew: "
                                       << kHowToWrite;
}

}  // namespace
}  // namespace axisgate::refusals
