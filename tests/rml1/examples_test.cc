// Every example and every error of the guideline, typed by hand in examples/.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/mill.h"
#include "tests/rml1/paragraphs.h"

namespace axisgate::rml1 {
namespace {

// The guideline's own examples of the parameter reader use a command that it does not have (2-5).
constexpr Parameter kInt{true, kIntLowest, kIntHighest, false, false};
constexpr Row kIp[] = {
    {"IP", Deed::ignored, "2-5", Takes::up_to, 4, Coordinates::kept, Tool::kept, {kInt, kInt, kInt, kInt}}};

std::span<const Row> rows_for(const Paragraph& example) {
  return example.all("%").empty() ? std::span<const Row>() : std::span<const Row>(kIp);
}

// "! 2 6" of an error, "~ 3" of anything less.
std::vector<std::string> told(const Played& played) {
  std::vector<std::string> lines;
  for (const Diagnostic& one : played.diagnostics) {
    lines.push_back(one.severity == Severity::error ? fmt::format("! {} {}", one.number, one.place.offset)
                                                    : fmt::format("~ {}", one.place.offset));
  }
  return lines;
}

std::vector<int> numbers(const Played& played) {
  std::vector<int> found;
  for (const Diagnostic& one : played.diagnostics) {
    if (one.severity == Severity::error) found.push_back(one.number);
  }
  return found;
}

std::vector<std::string> expected_diagnostics(const Paragraph& example) {
  std::vector<std::string> lines;
  for (const auto& [mark, text] : example.lines) {
    if (mark == "!" || mark == "~") lines.push_back(mark + " " + text);
  }
  return lines;
}

class Examples : public testing::TestWithParam<Paragraph> {};

TEST_P(Examples, AsTheGuidelineSays) {
  const std::string job = unescaped(GetParam().all("<").at(0));
  const Played played = play(job, test_profile(), {}, rows_for(GetParam()));
  EXPECT_THAT(played.commands, testing::ElementsAreArray(GetParam().all(">"))) << GetParam().all("<")[0];
  EXPECT_THAT(told(played), testing::ElementsAreArray(expected_diagnostics(GetParam()))) << GetParam().all("<")[0];
  for (const std::string& same : GetParam().all("=")) {
    const Played other = play(unescaped(same), test_profile(), {}, rows_for(GetParam()));
    EXPECT_EQ(other.commands, played.commands) << same;
    EXPECT_EQ(numbers(other), numbers(played)) << same;
  }
}

INSTANTIATE_TEST_SUITE_P(Guideline, Examples, testing::ValuesIn(paragraphs("examples")), [](const auto& one) {
  std::string name;
  for (const char c : one.param.where) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

TEST(Examples, ThereAreManyOfThem) { EXPECT_GE(paragraphs("examples").size(), 600u); }

}  // namespace
}  // namespace axisgate::rml1
